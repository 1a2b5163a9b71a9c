//! The hits of a picture, as it keeps them. A pixel that shows nothing costs four bytes, not those of a hit; colours, which look at
//! neighbours, find what they need in few bytes, apart from what shadows start with.
use super::pixel::{Edge, Hit};
use crate::geom::Vec3;
use crate::shadow::Receiver;
use serde::{Deserialize, Serialize};

/// A hit as colours see it: without its parameter, which is in the planes, and its proof.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Seen {
    /// About where it is.
    pub(super) point: Vec3,
    /// Unit normal, turned to the viewer.
    pub(super) normal: Vec3,
    /// Colour of the surface there, linear Rec. 709. Not certified.
    pub(super) color: [f64; 3],
    /// Index of the surface.
    pub(super) object: u32,
    /// Whether it is a proved hit.
    pub(super) proved: bool,
}

impl From<&Hit> for Seen {
    fn from(hit: &Hit) -> Self {
        let Hit { point, normal, color, object, receiver, .. } = *hit;
        let object = u32::try_from(object).expect("fewer surfaces than that");
        Self { point, normal, color, object, proved: receiver.is_some() }
    }
}

/// What is seen of a pixel beside its centre: an [`Edge`] without the room for rays that meet nothing.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Fringe {
    /// How many rays the grid has, and which of them meet something: bit `k` is that of ray `k`.
    rays: u32,
    met: u32,
    /// What they meet.
    seen: Box<[Seen]>,
    /// As in [`Edge`].
    pub(super) thin: Option<Box<Seen>>,
}

impl From<&Edge> for Fringe {
    fn from(edge: &Edge) -> Self {
        let met = edge.rays.iter().enumerate().map(|(k, ray)| u32::from(ray.is_some()) << k).sum();
        // Counted first, so that no byte is allocated in vain.
        let mut seen = Vec::with_capacity(edge.rays.iter().flatten().count());
        seen.extend(edge.rays.iter().flatten().map(Seen::from));
        let thin = edge.thin.as_ref().map(|hit| Box::new(hit.into()));
        Self { rays: edge.rays.len() as u32, met, seen: seen.into(), thin }
    }
}

impl Fringe {
    /// What each ray of the grid meets.
    pub(super) fn rays(&self) -> impl ExactSizeIterator<Item = Option<&Seen>> {
        let mut seen = self.seen.iter();
        (0..self.rays as usize).map(move |k| if self.met >> k & 1 == 1 { seen.next() } else { None })
    }

    /// What its rays meet.
    pub(super) fn seen(&self) -> &[Seen] {
        &self.seen
    }

    /// Whether it has as many hits as rays that meet something.
    pub(super) fn holds(&self) -> bool {
        self.rays <= u32::BITS && self.met.count_ones() as usize == self.seen.len()
    }
}

/// At most one hit for each pixel.
#[derive(Serialize, Deserialize)]
pub(super) struct Hits {
    /// For each pixel 0, or the number of its hit, from 1 on: 32 bits are enough, pictures have fewer pixels.
    places: Vec<u32>,
    seen: Vec<Seen>,
    /// Where shadows start, of the same hits.
    receivers: Vec<Option<Receiver>>,
}

impl Hits {
    /// Most bytes of a pixel.
    pub(super) const BYTES_PER_PIXEL: usize = size_of::<u32>() + size_of::<Seen>() + size_of::<Option<Receiver>>();

    pub(super) fn none(pixels: usize) -> Self {
        Self { places: vec![0; pixels], seen: Vec::new(), receivers: Vec::new() }
    }

    /// Pixels.
    pub(super) fn pixels(&self) -> usize {
        self.places.len()
    }

    /// Forgets the first pixels; there are then so many, the last of them without hits.
    pub(super) fn slide(&mut self, forget: usize, pixels: usize) {
        let old = std::mem::replace(self, Self::none(pixels));
        for index in forget..old.pixels() {
            self.put_from(index - forget, &old, index);
        }
    }

    /// Whether every number is that of a hit: what is read from a file may be anything.
    pub(super) fn holds(&self) -> bool {
        self.places.iter().all(|place| *place as usize <= self.seen.len()) && self.seen.len() == self.receivers.len()
    }

    pub(super) fn at(&self, index: usize) -> Option<&Seen> {
        let place = self.places[index].checked_sub(1)?;
        self.seen.get(place as usize)
    }

    /// The proved hit of a pixel, if it has one.
    pub(super) fn receiver(&self, index: usize) -> Option<&Receiver> {
        let place = self.places[index].checked_sub(1)?;
        self.receivers.get(place as usize)?.as_ref()
    }

    /// What is kept of the hit of a pixel, in the place of what it had.
    pub(super) fn put(&mut self, index: usize, hit: Option<&Hit>) {
        match hit {
            Some(hit) => self.keep(index, &hit.into(), hit.receiver.as_ref()),
            None => self.places[index] = 0,
        }
    }

    /// What other hits keep of the hit of a pixel there, in the place of what it had.
    pub(super) fn put_from(&mut self, index: usize, others: &Self, there: usize) {
        match others.at(there) {
            Some(seen) => self.keep(index, seen, others.receiver(there)),
            None => self.places[index] = 0,
        }
    }

    pub(super) fn keep(&mut self, index: usize, seen: &Seen, receiver: Option<&Receiver>) {
        let place = &mut self.places[index];
        if let Some(old) = place.checked_sub(1) {
            (self.seen[old as usize], self.receivers[old as usize]) = (*seen, receiver.copied());
        } else {
            self.seen.push(*seen);
            self.receivers.push(receiver.copied());
            *place = u32::try_from(self.seen.len()).expect("fewer pixels than that");
        }
    }
}

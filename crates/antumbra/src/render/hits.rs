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

/// A list that grows by whole pieces: nothing is copied when it does.
#[derive(Serialize, Deserialize)]
struct Pieces<T>(Vec<Vec<T>>);

impl<T> Pieces<T> {
    /// Elements of a piece.
    const SIZE: usize = 4096;

    fn len(&self) -> usize {
        self.0.last().map_or(0, |last| (self.0.len() - 1) * Self::SIZE + last.len())
    }

    fn get(&self, k: usize) -> Option<&T> {
        self.0.get(k / Self::SIZE)?.get(k % Self::SIZE)
    }

    /// Element `k`, in the place of the one that is there, or as the last.
    fn put(&mut self, k: usize, value: T) {
        let (piece, k) = (k / Self::SIZE, k % Self::SIZE);
        if piece == self.0.len() {
            self.0.push(Vec::with_capacity(Self::SIZE));
        }
        match self.0[piece].get_mut(k) {
            Some(place) => *place = value,
            None => self.0[piece].push(value),
        }
    }

    /// Whether all pieces but the last are full, as they are made.
    fn holds(&self) -> bool {
        let (last, full) = self.0.split_last().map_or((0, &[][..]), |(last, full)| (last.len(), full));
        last <= Self::SIZE && full.iter().all(|piece| piece.len() == Self::SIZE)
    }
}

/// At most one hit for each pixel.
#[derive(Serialize, Deserialize)]
pub(super) struct Hits {
    /// For each pixel 0, or the number of its hit, from 1 on: 32 bits are enough, pictures have fewer pixels.
    places: Vec<u32>,
    seen: Pieces<Seen>,
    /// Where shadows start, of the same hits.
    receivers: Pieces<Option<Receiver>>,
}

impl Hits {
    /// Most bytes of a pixel.
    pub(super) const BYTES_PER_PIXEL: usize = size_of::<u32>() + size_of::<Seen>() + size_of::<Option<Receiver>>();

    pub(super) fn none(pixels: usize) -> Self {
        Self { places: vec![0; pixels], seen: Pieces(Vec::new()), receivers: Pieces(Vec::new()) }
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
        let hits = self.seen.len();
        let pieces = self.seen.holds() && self.receivers.holds() && hits == self.receivers.len();
        pieces && self.places.iter().all(|place| *place as usize <= hits)
    }

    pub(super) fn at(&self, index: usize) -> Option<&Seen> {
        self.seen.get(self.places[index].checked_sub(1)? as usize)
    }

    /// The proved hit of a pixel, if it has one.
    pub(super) fn receiver(&self, index: usize) -> Option<&Receiver> {
        self.receivers.get(self.places[index].checked_sub(1)? as usize)?.as_ref()
    }

    /// The hit of a pixel, in the place of what it had.
    pub(super) fn put(&mut self, index: usize, hit: Option<&Hit>) {
        if let Some(hit) = hit {
            let place = self.place(index);
            self.seen.put(place, hit.into());
            self.receivers.put(place, hit.receiver);
        } else {
            self.places[index] = 0;
        }
    }

    /// What other hits keep of a pixel there, in the place of what it had.
    pub(super) fn put_from(&mut self, index: usize, others: &Self, there: usize) {
        if let Some(seen) = others.at(there) {
            self.keep(index, *seen, others.receiver(there).copied());
        } else {
            self.places[index] = 0;
        }
    }

    pub(super) fn keep(&mut self, index: usize, seen: Seen, receiver: Option<Receiver>) {
        let place = self.place(index);
        self.seen.put(place, seen);
        self.receivers.put(place, receiver);
    }

    /// Where the hit of a pixel is put: where its old one is, or behind all others.
    fn place(&mut self, index: usize) -> usize {
        let (place, hits) = (&mut self.places[index], self.seen.len());
        if *place == 0 {
            *place = u32::try_from(hits + 1).expect("fewer pixels than that");
        }
        *place as usize - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(k: usize) -> Seen {
        Seen {
            point: Vec3::new(k as f64, 0.0, 0.0),
            normal: Vec3::default(),
            color: [0.5; 3],
            object: 0,
            proved: false,
        }
    }

    #[test]
    fn hits_are_found_in_every_piece_after_changes_and_slides() {
        let pixels = 3 * Pieces::<Seen>::SIZE;
        let mut hits = Hits::none(pixels);
        (0..pixels).filter(|k| k % 3 > 0).for_each(|k| hits.keep(k, seen(k), None));
        (0..pixels).filter(|k| k % 3 == 1).for_each(|k| hits.keep(k, seen(k + 1), None));
        (0..pixels).filter(|k| k % 9 == 2).for_each(|k| hits.put(k, None));
        let wanted = |k: usize| match (k % 3, k % 9) {
            (0, _) | (_, 2) => None,
            (1, _) => Some(k + 1),
            _ => Some(k),
        };
        let found = |hits: &Hits, k: usize| hits.at(k).map(|seen| seen.point[0] as usize);
        assert!(hits.holds() && (0..pixels).all(|k| found(&hits, k) == wanted(k)));
        hits.slide(100, pixels);
        assert!(hits.holds() && (0..pixels - 100).all(|k| found(&hits, k) == wanted(k + 100)));
        assert!((pixels - 100..pixels).all(|k| hits.at(k).is_none()));
        hits.seen.0[0].pop();
        assert!(!hits.holds(), "a piece that is not full");
    }
}

//! The hits of a picture, as it keeps them. A pixel that shows nothing costs four bytes, not those of a hit; colours, which look at
//! neighbours, find what they need in few bytes, apart from where shadows start.
use super::pixel::{Edge, Hit};
use crate::geom::{Box3, Vec3};
use crate::shadow::Receiver;
use crate::trace::Sign;
use serde::{Deserialize, Serialize};

/// A hit as colours see it: without its parameter, which is in the planes, and its proof. A line of a cache.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Seen {
    /// About where it is.
    pub(super) point: Vec3,
    /// Unit normal, turned to the viewer.
    pub(super) normal: Vec3,
    /// Colour of the surface there, linear Rec. 709, rounded once more. Not certified.
    color: [f32; 3],
    /// The index of the surface, behind two bits: [`PROVED`], and then [`NEGATIVE`].
    surface: u32,
}

/// It is a proved hit.
const PROVED: u32 = 1;
/// The sign of the surface's function on the viewer's side of it.
const NEGATIVE: u32 = 2;
/// Bits for what is proved.
const BITS: u32 = 2;

impl From<&Hit> for Seen {
    fn from(hit: &Hit) -> Self {
        let side = hit.receiver.map(|receiver| receiver.side);
        Self::new(hit.point, hit.normal, hit.color, hit.object, side)
    }
}

impl Seen {
    /// `side`: of a proved hit, the sign of the surface's function on the viewer's side.
    pub(super) fn new(point: Vec3, normal: Vec3, color: [f64; 3], object: usize, side: Option<Sign>) -> Self {
        let object = u32::try_from(object).ok().filter(|object| *object < 1 << (u32::BITS - BITS));
        let proved = match side {
            None => 0,
            Some(Sign::Positive) => PROVED,
            Some(Sign::Negative) => PROVED | NEGATIVE,
        };
        let surface = object.expect("fewer surfaces than that") << BITS | proved;
        Self { point, normal, color: color.map(|c| c as f32), surface }
    }

    /// Colour of the surface there.
    pub(super) fn color(&self) -> [f64; 3] {
        self.color.map(f64::from)
    }

    /// Index of the surface.
    pub(super) fn object(&self) -> usize {
        (self.surface >> BITS) as usize
    }

    /// Whether it is a proved hit.
    pub(super) fn proved(&self) -> bool {
        self.surface & PROVED > 0
    }

    /// Of a proved hit, the sign of the surface's function on the viewer's side.
    fn side(&self) -> Option<Sign> {
        let sign = if self.surface & NEGATIVE > 0 { Sign::Negative } else { Sign::Positive };
        self.proved().then_some(sign)
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

    /// Whether it has as many hits as rays that meet something, on so many surfaces.
    pub(super) fn holds(&self, surfaces: usize) -> bool {
        let rays = (1..=u32::BITS).contains(&self.rays) && u64::from(self.met) >> self.rays == 0;
        let mut seen = self.seen.iter().chain(self.thin.as_deref());
        rays && self.met.count_ones() as usize == self.seen.len() && seen.all(|seen| seen.object() < surfaces)
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
    /// Enclosures of the proved ones of the same hits, where shadows start.
    starts: Pieces<Box3>,
}

impl Hits {
    /// Most bytes of a pixel.
    pub(super) const BYTES_PER_PIXEL: usize = size_of::<u32>() + size_of::<Seen>() + size_of::<Box3>();

    pub(super) fn none(pixels: usize) -> Self {
        Self { places: vec![0; pixels], seen: Pieces(Vec::new()), starts: Pieces(Vec::new()) }
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

    /// Whether every number is that of a hit on one of so many surfaces, and no two pixels have the same: what is read from a file may be anything.
    pub(super) fn holds(&self, surfaces: usize) -> bool {
        let hits = self.seen.len();
        let pieces = self.seen.holds() && self.starts.holds() && hits == self.starts.len();
        let mut taken = vec![false; hits];
        let mut own = |place: u32| match place.checked_sub(1) {
            Some(hit) => taken.get_mut(hit as usize).is_some_and(|taken| !std::mem::replace(taken, true)),
            None => true,
        };
        pieces
            && self.places.iter().all(|place| own(*place))
            && self.seen.0.iter().flatten().all(|seen| seen.object() < surfaces)
    }

    /// Whether a pixel has a hit.
    pub(super) fn is_hit(&self, index: usize) -> bool {
        self.places[index] > 0
    }

    pub(super) fn at(&self, index: usize) -> Option<&Seen> {
        self.seen.get(self.places[index].checked_sub(1)? as usize)
    }

    /// The proved hit of a pixel, if it has one.
    pub(super) fn receiver(&self, index: usize) -> Option<Receiver> {
        let seen = self.at(index)?;
        let point = *self.starts.get(self.places[index].checked_sub(1)? as usize)?;
        Some(Receiver { point, surface: seen.object(), side: seen.side()? })
    }

    /// The hit of a pixel, in the place of what it had.
    pub(super) fn put(&mut self, index: usize, hit: Option<&Hit>) {
        if let Some(hit) = hit {
            self.keep(index, hit.into(), hit.receiver.map(|receiver| receiver.point));
        } else {
            self.places[index] = 0;
        }
    }

    /// What other hits keep of a pixel there, in the place of what it had.
    pub(super) fn put_from(&mut self, index: usize, others: &Self, there: usize) {
        if let Some(seen) = others.at(there) {
            self.keep(index, *seen, others.receiver(there).map(|receiver| receiver.point));
        } else {
            self.places[index] = 0;
        }
    }

    /// A hit, and where it is if it is proved.
    pub(super) fn keep(&mut self, index: usize, seen: Seen, start: Option<Box3>) {
        let place = self.place(index);
        self.seen.put(place, seen);
        self.starts.put(place, start.unwrap_or_else(|| seen.point.to_box()));
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
    use antumbra_interval::Interval;

    fn seen(k: usize) -> Seen {
        Seen::new(Vec3::new(k as f64, 0.0, 0.0), Vec3::default(), [0.5; 3], 0, None)
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
        assert!(hits.holds(1) && (0..pixels).all(|k| found(&hits, k) == wanted(k)));
        hits.slide(100, pixels);
        assert!(hits.holds(1) && (0..pixels - 100).all(|k| found(&hits, k) == wanted(k + 100)));
        assert!((pixels - 100..pixels).all(|k| hits.at(k).is_none()));
        hits.seen.0[0].pop();
        assert!(!hits.holds(1), "a piece that is not full");
    }

    #[test]
    fn proved_hits_come_back_and_others_do_not() {
        let hit = |x: f64, side: Option<Sign>| {
            let (point, normal, color) = (Vec3::new(x, 0.0, 0.0), Vec3::new(0.0, 0.0, 1.0), [0.1, 0.2, 0.3]);
            let around = Box3(point.0.map(|c| Interval::new(c - 0.5, c + 0.25)));
            let receiver = side.map(|side| Receiver { point: around, surface: 7, side });
            Hit { t: Interval::ONE, point, normal, color, object: 7, floor: false, receiver }
        };
        let all = [hit(1.0, Some(Sign::Negative)), hit(5.0, Some(Sign::Positive)), hit(2.0, None)];
        let mut hits = Hits::none(9);
        (3..).zip(&all).for_each(|(index, hit)| hits.put(index, Some(hit)));
        let check = |hits: &Hits, from: usize| {
            for (index, hit) in (from..).zip(&all) {
                let seen = hits.at(index).unwrap();
                assert_eq!(hits.receiver(index), hit.receiver);
                assert_eq!((seen.point, seen.normal, seen.object()), (hit.point, hit.normal, 7));
                assert!((0..3).all(|c| (seen.color()[c] - hit.color[c]).abs() < 1e-7));
                assert_eq!(seen.proved(), hit.receiver.is_some());
            }
            assert!(hits.receiver(from + 3).is_none() && hits.holds(8));
        };
        check(&hits, 3);
        hits.slide(2, 9);
        check(&hits, 1);
        assert!(!hits.holds(7), "a surface that is none");
        hits.places[8] = hits.places[1];
        assert!(!hits.holds(8), "one hit for two pixels");
        hits.places[8] = 4;
        assert!(!hits.holds(8), "a hit that is none");
    }

    #[test]
    fn grids_have_as_many_hits_as_rays_that_meet_something() {
        let whole = || Fringe { rays: 16, met: 0b101, seen: vec![seen(0), seen(1)].into(), thin: None };
        assert!(whole().holds(1) && !whole().holds(0));
        for broken in [
            Fringe { rays: 2, ..whole() },
            Fringe { rays: 0, met: 1, seen: vec![seen(0)].into(), thin: None },
            Fringe { rays: 33, ..whole() },
            Fringe { met: 0b111, ..whole() },
        ] {
            assert!(!broken.holds(1), "{broken:?}");
        }
    }
}

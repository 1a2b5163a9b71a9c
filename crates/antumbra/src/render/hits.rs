//! The hits of a picture. A pixel that shows nothing costs four bytes, not those of a hit.
use super::pixel::Hit;
use serde::{Deserialize, Serialize};

/// At most one hit for each pixel.
#[derive(Serialize, Deserialize)]
pub(super) struct Hits {
    /// For each pixel 0, or the number of its hit, from 1 on: 32 bits are enough, pictures have fewer pixels.
    places: Vec<u32>,
    hits: Vec<Hit>,
}

impl Hits {
    pub(super) fn none(pixels: usize) -> Self {
        Self { places: vec![0; pixels], hits: Vec::new() }
    }

    /// Pixels.
    pub(super) fn pixels(&self) -> usize {
        self.places.len()
    }

    /// Forgets the first pixels; there are then so many, the last of them without hits.
    pub(super) fn slide(&mut self, forget: usize, pixels: usize) {
        let old = std::mem::replace(self, Self::none(pixels));
        for (index, place) in old.places.iter().skip(forget).enumerate() {
            self.put(index, place.checked_sub(1).map(|place| old.hits[place as usize]));
        }
    }

    /// Whether every number is that of a hit: what is read from a file may be anything.
    pub(super) fn holds(&self) -> bool {
        self.places.iter().all(|place| *place as usize <= self.hits.len())
    }

    pub(super) fn at(&self, index: usize) -> Option<&Hit> {
        let place = self.places[index].checked_sub(1)?;
        self.hits.get(place as usize)
    }

    /// The hit of a pixel, in the place of what it had.
    pub(super) fn put(&mut self, index: usize, hit: Option<Hit>) {
        let place = &mut self.places[index];
        match (hit, place.checked_sub(1)) {
            (None, _) => *place = 0,
            (Some(hit), Some(old)) => self.hits[old as usize] = hit,
            (Some(hit), None) => {
                self.hits.push(hit);
                *place = u32::try_from(self.hits.len()).expect("fewer pixels than that");
            }
        }
    }
}

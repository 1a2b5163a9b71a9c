//! A light of a scene.
use crate::geom::Rect;

/// A rectangle that shines to both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is: the exact light of every proof.
    pub rect: Rect,
    /// Its colour (linear Rec. 709) times its strength, relative to one neutral light. Not certified.
    pub color: [f64; 3],
}

impl Light {
    /// A white light of strength 1, a little warm.
    pub const WHITE: [f64; 3] = [0.95, 0.92, 0.86];

    /// A light of that colour.
    #[must_use]
    pub fn white(rect: Rect) -> Self {
        Self { rect, color: Self::WHITE }
    }
}

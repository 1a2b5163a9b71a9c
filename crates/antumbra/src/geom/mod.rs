//! Points, boxes, beams, rectangles of light, the camera. This room knows no formula.
mod beam;
mod camera;
mod clip;
mod fan;
pub mod halfplanes;
mod leaving;
mod polar;
mod rect;
mod remainder;
mod sheet;
pub mod strips;
mod vector;

pub use beam::{Beam, section};
pub use camera::{Camera, Film};
pub use clip::{Clip, Passage};
pub use fan::Fan;
pub use leaving::Leaving;
pub use polar::Polar;
pub use rect::Rect;
pub use remainder::remainder;
pub use sheet::Sheet;
pub(crate) use vector::axes;
pub use vector::{Box3, Vec3};

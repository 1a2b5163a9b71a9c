//! What an open bracket probably holds. For colours only: the bracket stays as it is, in the planes and in all that is said of it.
//!
//! Where f has a kink that runs along the surface, as a smooth union has, brackets of single hits stay open, often at [0, 1]. Their
//! middle would stand out as a speck; the light of the hits beside is what one sees there, as far as the bracket allows it.
use super::Frame;
use super::by_proof::BLOCK;
use super::hits::Hits;

/// How far it looks around, in pixels.
const REACH: usize = 4;
// A picture in bands holds a row of tiles around what it finishes: edges look one pixel further.
const _: () = assert!(REACH < BLOCK);
/// Cosine between the normals of hits that are of one smooth surface.
const SMOOTH: f64 = 0.9;

/// The visible fraction of a light that a hit is drawn with: the middle of its bracket if that is at most `tolerance` wide. Else the
/// mean of the nearest such hits of the same surface, by the inverse squares of their distances in the picture, and of that
/// the nearest value within the bracket.
pub(super) fn likely(hits: &Hits, frame: &Frame, light: usize, index: usize, tolerance: f64) -> f64 {
    let planes = &frame.lights[light];
    let middle = planes.visible(index);
    let Some(hit) = hits.at(index).filter(|_| planes.is_open(index, tolerance)) else { return middle };
    let (column, row) = (index % frame.width, index / frame.width);
    for reach in 1..=REACH {
        let columns = column.saturating_sub(reach)..(column + reach + 1).min(frame.width);
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(frame.height);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let at = y * frame.width + x;
            let known = |other: &&super::hits::Seen| {
                other.object() == hit.object()
                    && other.proved()
                    && other.normal.dot(hit.normal) > SMOOTH
                    && !planes.is_open(at, tolerance)
            };
            if hits.at(at).filter(known).is_some() {
                let weight = 1.0 / (x.abs_diff(column).pow(2) + y.abs_diff(row).pow(2)) as f64;
                sum += weight * planes.visible(at);
                weights += weight;
            }
        }
        if weights > 0.0 {
            return (sum / weights).clamp(planes.visible_lo[index], planes.visible_hi[index]);
        }
    }
    middle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Vec3;
    use crate::render::hits::Seen;
    use crate::trace::Sign;

    const TOLERANCE: f64 = 0.01;

    fn hit(object: usize, normal: Vec3, side: Option<Sign>) -> Seen {
        Seen::new(Vec3::default(), normal, [0.5; 3], object, side)
    }

    const UP: Vec3 = Vec3([0.0, 0.0, 1.0]);
    const PROVED: Option<Sign> = Some(Sign::Positive);

    /// A row of hits on one flat surface with these brackets.
    fn row(brackets: &[[f64; 2]]) -> (Hits, Frame) {
        let mut frame = Frame::new(brackets.len(), 1, 1).unwrap();
        let mut hits = Hits::none(brackets.len());
        for (k, [lo, hi]) in brackets.iter().enumerate() {
            (frame.lights[0].visible_lo[k], frame.lights[0].visible_hi[k]) = (*lo, *hi);
            hits.keep(k, hit(0, UP, PROVED), None);
        }
        (hits, frame)
    }

    #[test]
    fn open_brackets_are_drawn_as_what_is_beside_them() {
        let (hits, frame) = row(&[[0.9, 0.9], [0.0, 1.0], [0.7, 0.7], [0.0, 1.0], [0.0, 1.0], [0.1, 0.1]]);
        let at = |index| likely(&hits, &frame, 0, index, TOLERANCE);
        assert!((at(1) - 0.8).abs() < 1e-12, "the mean of both sides");
        assert_eq!((at(0), at(3), at(4)), (0.9, 0.7, 0.1), "the nearest");
    }

    #[test]
    fn the_bracket_holds() {
        let (hits, frame) = row(&[[1.0, 1.0], [0.2, 0.6], [1.0, 1.0], [0.0, 0.0], [0.2, 0.6], [0.0, 0.0]]);
        assert_eq!(likely(&hits, &frame, 0, 1, TOLERANCE), 0.6);
        assert_eq!(likely(&hits, &frame, 0, 4, TOLERANCE), 0.2);
        assert_eq!(likely(&hits, &frame, 0, 4, 0.5), 0.4, "as narrow as was asked for: its middle");
    }

    #[test]
    fn other_surfaces_and_bends_say_nothing() {
        let (mut hits, frame) = row(&[[1.0, 1.0], [0.0, 1.0], [1.0, 1.0], [0.0, 1.0]]);
        hits.keep(0, hit(1, UP, PROVED), None);
        hits.keep(2, hit(0, Vec3::new(1.0, 0.0, 0.0), PROVED), None);
        assert_eq!(likely(&hits, &frame, 0, 1, TOLERANCE), 0.5);
        hits.keep(2, hit(0, UP, None), None);
        assert_eq!(likely(&hits, &frame, 0, 1, TOLERANCE), 0.5, "what is not proved to be a hit has no light");
    }
}

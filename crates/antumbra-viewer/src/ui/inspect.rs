//! What is known of one pixel, in words.
use antumbra::render::{Frame, Method};

/// The lines for a pixel of a frame: what is proved, the enclosure of the hit, the brackets, the cost.
#[must_use]
pub fn lines(frame: &Frame, method: Method, tolerance: f64, index: usize) -> Vec<(String, String)> {
    let line = |name: &str, text: String| (name.to_owned(), text);
    let certified = method == Method::Certified;
    let verdict = match frame.verdict[index] {
        0 => "empty, proved",
        1 => "hit, proved",
        Frame::PARTLY => "edge, proved: the centre misses, other rays hit",
        2 if certified => "undecided: resolution (too thin for the search)",
        // What their beams report is all that they know.
        2 => "hit, as far as this method tells",
        3 => "undecided: touching (no change of sign)",
        4 => "undecided: domain (f may be undefined here)",
        5 => "undecided: budget (too much work)",
        _ => "not looked at yet",
    };
    let mut out = vec![line("verdict", verdict.to_owned())];
    let (lo, hi) = (frame.t_lo[index], frame.t_hi[index]);
    if !lo.is_nan() {
        out.push(line("hit at", format!("t in [{lo:.9}, {hi:.9}], {:.1e} wide", hi - lo)));
        let many = frame.lights.len() > 1;
        for (k, light) in frame.lights.iter().enumerate() {
            let (lo, hi) = (light.visible_lo[index], light.visible_hi[index]);
            let class = match (lo, hi) {
                _ if lo.is_nan() => "no light asked for",
                (1.0, _) => "lit",
                (_, 0.0) => "dark",
                (0.0, 1.0) => "not known",
                _ if hi - lo > tolerance * (1.0 + 1e-9) => "wider than the tolerance",
                _ => "penumbra",
            };
            let name = if many { format!("light {}", k + 1) } else { "light".to_owned() };
            out.push((name, format!("[{lo:.5}, {hi:.5}] visible: {class}")));
        }
    }
    let (lo, hi) = (frame.coverage_lo[index], frame.coverage_hi[index]);
    if frame.verdict[index] != Frame::UNSEEN {
        out.push(line("coverage", if lo == hi { format!("{lo}") } else { format!("[{lo:.3}, {hi:.3}]") }));
        out.push(line("cost", format!("{} evaluations", frame.cost[index])));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_state_of_a_pixel_has_words() {
        let mut frame = Frame::new(1, 1, 2).unwrap();
        let shown = |frame: &Frame, method| lines(frame, method, 0.01, 0);
        assert_eq!(shown(&frame, Method::Certified), [("verdict".to_owned(), "not looked at yet".to_owned())]);
        let mut seen = vec![];
        for code in 0..=6 {
            frame.verdict[0] = code;
            seen.push(shown(&frame, Method::Certified)[0].1.clone());
        }
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), 7, "{seen:?}");
        (frame.t_lo[0], frame.t_hi[0], frame.verdict[0]) = (1.25, 1.5, 1);
        for light in &mut frame.lights {
            (light.visible_lo[0], light.visible_hi[0]) = (0.25, 0.5);
        }
        (frame.lights[1].visible_lo[0], frame.lights[1].visible_hi[0]) = (1.0, 1.0);
        let all = shown(&frame, Method::Certified);
        assert_eq!(all[1].1, "t in [1.250000000, 1.500000000], 2.5e-1 wide");
        assert_eq!(all[2], ("light 1".to_owned(), "[0.25000, 0.50000] visible: wider than the tolerance".to_owned()));
        assert!(all[3].1.ends_with("lit"));
        let rays = Method::from_name("rays").unwrap();
        frame.verdict[0] = 2;
        assert!(shown(&frame, rays)[0].1.contains("as far as this method"));
    }
}

//! What came of one function.
use antumbra_interval::Interval;

/// Results of all comparisons of one function.
pub(crate) struct Count {
    pub(crate) name: &'static str,
    /// Most floats between a bound and the tightest one.
    pub(crate) allowed: u64,
    /// Points compared with MPFR.
    pub(crate) points: u64,
    /// Boxes compared with inari.
    pub(crate) boxes: u64,
    /// Members of boxes whose values by MPFR were looked for in the enclosures.
    pub(crate) members: u64,
    /// Floats between the lower (upper) bound and the tightest one, at worst, over points.
    pub(crate) at_points: [u64; 2],
    /// The same over boxes.
    pub(crate) at_boxes: [u64; 2],
    /// How many points were enclosed by the tightest bounds themselves.
    pub(crate) tightest: u64,
    /// Boxes on which inari's enclosure was not the tightest.
    pub(crate) narrower: u64,
    pub(crate) violations: Vec<String>,
}

impl Count {
    pub(crate) fn new(name: &'static str, allowed: u64) -> Self {
        Self {
            name,
            allowed,
            points: 0,
            boxes: 0,
            members: 0,
            at_points: [0; 2],
            at_boxes: [0; 2],
            tightest: 0,
            narrower: 0,
            violations: vec![],
        }
    }

    /// Compares an enclosure with the tightest one; the floats by which its ends are farther out, if it is one.
    pub(crate) fn excess(&mut self, got: Interval, tight: Interval, what: impl Fn() -> String) -> Option<[u64; 2]> {
        let ends = match (got.is_empty(), tight.is_empty()) {
            (true, true) => Some([0, 0]),
            (false, false) => outside(tight.lo(), got.lo()).zip(outside(-tight.hi(), -got.hi())).map(|(a, b)| [a, b]),
            _ => None,
        };
        if ends.is_none_or(|ends| ends.iter().any(|e| *e > self.allowed)) {
            self.violations.push(format!("{}{}: {got}, tightest is {tight}", self.name, what()));
        }
        ends
    }
}

/// How many floats `bound` is below `tight`; `None` if it is above.
fn outside(tight: f64, bound: f64) -> Option<u64> {
    let rank = |v: f64| {
        let bits = (v + 0.0).to_bits() as i64;
        i128::from(if bits < 0 { i64::MIN - bits } else { bits })
    };
    u64::try_from(rank(tight) - rank(bound)).ok()
}

/// A table in Markdown.
pub(crate) fn table(counts: &[Count]) -> String {
    let mut out = String::from(
        "| function | points (MPFR) | boxes (inari) | members (MPFR) | violations | worst at points | tightest at points | worst on boxes | allowed |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for c in counts {
        let ends = |[lo, hi]: [u64; 2]| format!("{lo}, {hi}");
        let (points, boxes) = (ends(c.at_points), if c.boxes == 0 { "-".into() } else { ends(c.at_boxes) });
        let share = c.tightest as f64 * 100.0 / c.points.max(1) as f64;
        out += &format!(
            "| `{}` | {} | {} | {} | {} | {points} | {share:.0} % | {boxes} | {} |\n",
            c.name,
            c.points,
            c.boxes,
            c.members,
            c.violations.len(),
            c.allowed
        );
    }
    let narrower: Vec<String> =
        counts.iter().filter(|c| c.narrower > 0).map(|c| format!("{} {}", c.name, c.narrower)).collect();
    if !narrower.is_empty() {
        out +=
            &format!("\nBoxes on which inari is not the tightest and MPFR confirms ours: {}.\n", narrower.join(", "));
    }
    out
}

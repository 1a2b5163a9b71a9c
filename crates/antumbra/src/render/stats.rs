//! What a render found and what it cost.
use serde::{Deserialize, Serialize};

/// Counters and times; all counters are independent of machine and threads, the times are wall-clock seconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stats {
    /// Method by name.
    pub method: String,
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Threads used.
    pub threads: usize,
    /// Pixels whose beam may meet a surface (for rays: whose middle ray may).
    pub hits: u64,
    /// Of these, pixels of the floor.
    pub floor_hits: u64,
    /// Pixels proved empty.
    pub proved_empty: u64,
    /// Pixels whose centre ray is proved to meet a surface.
    pub proved_hit: u64,
    /// Pixels whose centre ray is proved to miss, and some other ray to meet a surface.
    pub proved_partly: u64,
    /// Pixels undecided because the search ended at its smallest interval: all hits of the paper's methods; of the
    /// certified one, pixels at the very edge of a silhouette.
    pub undecided_resolution: u64,
    /// ... because f seems to touch 0 without a change of sign.
    pub undecided_touching: u64,
    /// ... because f may be undefined or discontinuous there.
    pub undecided_domain: u64,
    /// ... because the permitted work was spent.
    pub undecided_budget: u64,
    /// Lights. With several, the classes below count every pair of a hit and a light.
    pub lights: usize,
    /// Hits that see the whole light (certified: proved).
    pub lit: u64,
    /// Hits that see a part of it.
    pub partly: u64,
    /// Hits that see nothing of it (certified: proved).
    pub dark: u64,
    /// Hits whose bracket is wider than the tolerance.
    pub brackets_open: u64,
    /// Width of the widest bracket.
    pub bracket_width_max: f64,
    /// Of the hits in shadow, those whose surface is turned to the light's centre: the others are dark anyway.
    pub in_shadow_facing: u64,
    /// Hits whose initial shadow beam may be blocked (paper: "initial beams occluded").
    pub initial_occluded: u64,
    /// Of these, hits that turned out fully lit, up to the tolerance: false alarms of the first beam.
    pub false_alarms: u64,
    /// Pixel beams (or rays); certified: frusta.
    pub pixel_beams: u64,
    /// Initial shadow beams; certified: shafts.
    pub initial_beams: u64,
    /// Sub-beams (or shadow rays): the paper's "No. beams"; certified: rectangles of the light.
    pub beams: u64,
    /// Evaluations of inclusion functions to build the grid.
    pub grid_evaluations: u64,
    /// ... to find the hits.
    pub primary_evaluations: u64,
    /// ... to find the shadows.
    pub shadow_evaluations: u64,
    /// ... to smooth edges within what is met.
    pub edge_evaluations: u64,
    /// The sum of these four.
    pub evaluations: u64,
    /// Questions to surfaces that were asked in batches: evaluations, and gradients at hits.
    pub batched_questions: u64,
    /// Lanes of the vectors that answered them. The quotient is the occupancy of the lanes.
    pub batch_lanes: u64,
    /// Time for the grid.
    pub grid_seconds: f64,
    /// Time for the hits.
    pub primary_seconds: f64,
    /// Time for the shadows.
    pub shadow_seconds: f64,
    /// Time for colours.
    pub shading_seconds: f64,
    /// The sum of these four.
    pub seconds: f64,
}

impl Stats {
    /// Pixels of the certified method that are neither proved empty nor proved to show a surface, whatever the reason.
    #[must_use]
    pub fn undecided(&self) -> u64 {
        self.undecided_resolution + self.undecided_touching + self.undecided_domain + self.undecided_budget
    }

    /// With the sums filled in.
    pub(super) fn totalled(&self) -> Self {
        Self {
            evaluations: self.grid_evaluations
                + self.primary_evaluations
                + self.shadow_evaluations
                + self.edge_evaluations,
            seconds: self.grid_seconds + self.primary_seconds + self.shadow_seconds + self.shading_seconds,
            ..self.clone()
        }
    }

    /// With those of another part of the same picture, which was drawn at the same time.
    pub(super) fn join(&mut self, other: &Self) {
        macro_rules! each {
            ($combine:path: $($field:ident)*) => { $( self.$field = $combine(self.$field, other.$field); )* };
        }
        each!(std::ops::Add::add: threads hits floor_hits proved_empty proved_hit proved_partly undecided_resolution
            undecided_touching undecided_domain undecided_budget lit partly dark brackets_open in_shadow_facing
            initial_occluded false_alarms pixel_beams initial_beams beams primary_evaluations shadow_evaluations
            edge_evaluations batched_questions batch_lanes);
        // Each part builds the same grid.
        each!(u64::max: grid_evaluations);
        each!(f64::max: bracket_width_max grid_seconds primary_seconds shadow_seconds shading_seconds);
    }

    /// As they were before the shadows, for another method.
    pub(super) fn forget_shadows(&mut self, method: &str) {
        let old = std::mem::take(self);
        *self = Self {
            method: method.to_owned(),
            lit: 0,
            partly: 0,
            dark: 0,
            brackets_open: 0,
            bracket_width_max: 0.0,
            in_shadow_facing: 0,
            initial_occluded: 0,
            false_alarms: 0,
            initial_beams: 0,
            beams: 0,
            shadow_evaluations: 0,
            shadow_seconds: 0.0,
            shading_seconds: 0.0,
            ..old
        };
    }
}

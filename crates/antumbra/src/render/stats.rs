//! What a render found and what it cost.
use serde::Serialize;

/// Counters and times; all counters are independent of machine and threads, the times are wall-clock seconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
    /// Hits with shadow index 0.
    pub lit: u64,
    /// Hits with a shadow index between 0 and 1.
    pub partly: u64,
    /// Hits with shadow index 1.
    pub dark: u64,
    /// Of the hits in shadow, those whose surface is turned to the light's centre: the others are dark anyway.
    pub in_shadow_facing: u64,
    /// Hits whose initial shadow beam may be blocked (paper: "initial beams occluded").
    pub initial_occluded: u64,
    /// Pixel beams (or rays).
    pub pixel_beams: u64,
    /// Initial shadow beams.
    pub initial_beams: u64,
    /// Sub-beams (or shadow rays): the paper's "No. beams".
    pub beams: u64,
    /// Evaluations of inclusion functions to build the grid.
    pub grid_evaluations: u64,
    /// ... to find the hits.
    pub primary_evaluations: u64,
    /// ... to find the shadows.
    pub shadow_evaluations: u64,
    /// The sum of these three.
    pub evaluations: u64,
    /// Time for the grid.
    pub grid_seconds: f64,
    /// Time for the hits.
    pub primary_seconds: f64,
    /// Time for the shadows.
    pub shadow_seconds: f64,
    /// The sum of these three.
    pub seconds: f64,
}

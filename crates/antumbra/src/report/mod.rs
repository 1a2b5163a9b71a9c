//! The paper's tables and figures, computed anew: [`report`] renders what an [`Exhibit`] needs and puts our numbers
//! beside the published ones.
//!
//! Source: Florez-Diaz and Sbert, "Reliable Soft Shadows over Implicit Surfaces", WSCG 2010. Its formulas are known;
//! its cameras, lights and its twister are not, so ours are reconstructions and only ratios and shares can be compared.
mod figures;
mod mosaic;
mod published;
mod runs;
mod sweeps;
mod table1;

use crate::image::{self, Planes};
use crate::render::{self, RenderSpec, RunSpec};
use crate::scene;
pub use mosaic::Sheet;
use runs::Runs;

/// A table or a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exhibit {
    /// Table 1: beams and times of the four surfaces.
    Table1,
    /// How the shadows depend on the offset at which shadow beams start.
    Offsets,
    /// How the cost depends on the grid.
    Grids,
    /// Figure 1: rays miss thin parts of a surface that beams find.
    Fig1,
    /// Figure 5: rays miss thin parts of a shadow that beams find.
    Fig5,
    /// Figure 6: the four surfaces.
    Fig6,
    /// Figure 7: initial beam blocked, and truly in shadow.
    Fig7,
}

impl Exhibit {
    /// Every exhibit with its name on the command line and what it is.
    pub const ALL: [(Self, &'static str, &'static str); 7] = [
        (Self::Table1, "table1", "beams and times of the four surfaces, our columns beside the paper's"),
        (Self::Offsets, "offsets", "shadows for several offsets of the shadow beams (--offset has no say)"),
        (Self::Grids, "grids", "cost for several grids (--grid has no say)"),
        (Self::Fig1, "fig1", "rays against beams on thin surfaces"),
        (Self::Fig5, "fig5", "the same over a floor that shows the shadow (with or without --floor)"),
        (Self::Fig6, "fig6", "the four surfaces with their soft shadows"),
        (Self::Fig7, "fig7", "initial beam blocked in blue, truly in shadow in red"),
    ];

    /// The exhibit of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, n, _)| *n == name).map(|(exhibit, ..)| exhibit)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(e, ..)| *e == self).map_or("", |(_, name, _)| name)
    }

    /// Whether it has pictures.
    #[must_use]
    pub fn has_pictures(self) -> bool {
        !matches!(self, Self::Table1 | Self::Offsets | Self::Grids)
    }
}

/// What came out.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// One line.
    pub title: String,
    /// Tables, in order.
    pub tables: Vec<Table>,
    /// Pictures, in order.
    pub pictures: Vec<Picture>,
    /// Remarks, one sentence or a few each.
    pub notes: Vec<String>,
}

/// A table of text; every row has as many cells as the header.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Heads of the columns.
    pub header: Vec<String>,
    /// Rows of cells.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    fn new<const N: usize>(caption: &str, header: [&str; N]) -> Self {
        Self { caption: caption.to_owned(), header: header.map(str::to_owned).into(), rows: vec![] }
    }

    fn row<const N: usize>(&mut self, cells: [String; N]) {
        debug_assert_eq!(N, self.header.len());
        self.rows.push(cells.into());
    }
}

/// A picture of a report.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Name of the file without its extension.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// One plane, the colours.
    pub planes: Planes,
}

/// Why an exhibit could not be made.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A preset does not compile (never, as tested).
    #[error(transparent)]
    Scene(#[from] scene::Error),
    /// The picture cannot be begun.
    #[error(transparent)]
    Render(#[from] render::Error),
    /// The picture cannot be put together.
    #[error(transparent)]
    Image(#[from] image::Error),
}

/// Computes an exhibit and tells `progress` the share that is done, 0 to 1. Of `spec` everything counts but the
/// method, which the exhibit chooses, and what [`Exhibit::ALL`] says has no say. Cost: four to thirty renders.
///
/// # Errors
/// See [`Error`].
pub fn report(
    exhibit: Exhibit,
    spec: &RenderSpec,
    run: RunSpec,
    progress: &mut dyn FnMut(f64),
) -> Result<Report, Error> {
    let mut runs = Runs::new(spec, run, progress);
    match exhibit {
        Exhibit::Table1 => table1::report(&mut runs),
        Exhibit::Offsets => sweeps::offsets(&mut runs),
        Exhibit::Grids => sweeps::grids(&mut runs),
        Exhibit::Fig1 => figures::rays_and_beams(&mut runs, "fig1", false),
        Exhibit::Fig5 => figures::rays_and_beams(&mut runs, "fig5", true),
        Exhibit::Fig6 => figures::surfaces(&mut runs),
        Exhibit::Fig7 => figures::shadow_tests(&mut runs),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_exhibit_is_complete_and_progress_never_goes_back() {
        let spec = RenderSpec { width: 6, height: 5, sub_beams: 2, grid: 8, ..RenderSpec::default() };
        for (exhibit, name, _) in Exhibit::ALL {
            assert_eq!((Exhibit::from_name(name), exhibit.name()), (Some(exhibit), name));
            let mut seen = vec![0.0];
            let made = report(exhibit, &spec, RunSpec { threads: Some(1) }, &mut |share| seen.push(share)).unwrap();
            assert!(seen.windows(2).all(|w| w[0] <= w[1]) && seen.iter().all(|s| *s <= 1.0), "{name}: {seen:?}");
            assert_eq!(seen.last(), Some(&1.0), "{name}: the number of renders was announced wrongly");
            assert_eq!(made.pictures.is_empty(), !exhibit.has_pictures(), "{name}");
            assert!(made.tables.iter().all(|t| !t.rows.is_empty()), "{name}");
            assert!(made.tables.iter().all(|t| t.rows.iter().all(|r| r.len() == t.header.len())), "{name}");
        }
    }
}

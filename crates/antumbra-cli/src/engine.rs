//! The part of the heart that the commands use.
//!
//! Everything that the program asks of the heart is named here, and nothing else, so that the commands do not depend
//! on where the heart keeps it. For now the rooms `scene`, `render` and `paper` are stand-ins of the same shape: a
//! shaded ball for every scene.

/// Stand-in of the heart's `scene`.
pub(crate) mod scene {
    /// A scene that can be rendered.
    #[derive(Clone, Debug)]
    pub(crate) struct Scene;

    /// Names of all presets.
    pub(crate) fn preset_names() -> Vec<&'static str> {
        vec!["orthocircle", "chubs", "kusner", "mcmullen", "twister"]
    }

    /// The preset of that name.
    pub(crate) fn preset(name: &str) -> Option<Scene> {
        preset_names().contains(&name).then_some(Scene)
    }

    /// A formula that cannot be understood.
    #[derive(Debug)]
    pub(crate) struct Error(String);

    impl Error {
        /// Several lines: the place with a caret, and advice.
        pub(crate) fn render(&self) -> String {
            self.0.clone()
        }
    }

    /// The scene of a formula in x, y, z with a default framing.
    pub(crate) fn from_formula(text: &str) -> Result<Scene, Error> {
        let known = |c: char| "xyz0123456789+-*/^().= \n".contains(c);
        if text.trim().is_empty() {
            return Err(Error("the formula is empty; write one in x, y, z, such as x^2 + y^2 + z^2 - 1".to_owned()));
        }
        match text.chars().position(|c| !known(c)) {
            None => Ok(Scene),
            Some(at) => {
                Err(Error(format!("line 1, column {}: unexpected character\n  {text}\n  {:>at$}^", at + 1, "")))
            }
        }
    }
}

/// Stand-in of the heart's `render`.
pub(crate) mod render {
    use std::{
        collections::BTreeMap,
        time::{Duration, Instant},
    };

    use antumbra::image::{COLOR_PLANE, Plane, Planes, Rounding};

    use super::scene::Scene;

    /// How light and surface are found.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(crate) enum Method {
        Paper,
        Fixed49,
        PaperQuadtree,
        Paper4,
        Rays,
        RaysMc,
    }

    impl Method {
        /// All methods.
        pub(crate) const ALL: &[Self] =
            &[Self::Paper, Self::Fixed49, Self::PaperQuadtree, Self::Paper4, Self::Rays, Self::RaysMc];
        /// The method used where none is named.
        pub(crate) const DEFAULT: Self = Self::Paper;

        /// The name on the command line and in files.
        pub(crate) fn name(self) -> &'static str {
            match self {
                Self::Paper => "paper",
                Self::Fixed49 => "fixed49",
                Self::PaperQuadtree => "paper-quadtree",
                Self::Paper4 => "paper-4",
                Self::Rays => "rays",
                Self::RaysMc => "rays-mc",
            }
        }

        /// One line about it.
        pub(crate) fn summary(self) -> &'static str {
            match self {
                Self::Paper => "one shadow beam to the whole light; n x n sub-beams where it is blocked",
                Self::Fixed49 => "always n x n shadow beams",
                Self::PaperQuadtree => "the light subdivided as a quadtree",
                Self::Paper4 => "four first beams, for large lights",
                Self::Rays => "n x n point-sampled shadow rays on a regular grid",
                Self::RaysMc => "n x n point-sampled shadow rays at random",
            }
        }
    }

    /// What to draw.
    #[derive(Clone, Debug)]
    pub(crate) struct RenderSpec {
        pub(crate) width: usize,
        pub(crate) height: usize,
        pub(crate) method: Method,
        pub(crate) light_scale: f64,
        pub(crate) floor: bool,
        pub(crate) grid: usize,
        pub(crate) sub_beams: usize,
        pub(crate) offset: Option<f64>,
        pub(crate) seed: u64,
    }

    /// How to run.
    #[derive(Clone, Debug, Default)]
    pub(crate) struct RunSpec {
        pub(crate) threads: Option<usize>,
    }

    /// Counters and times.
    #[derive(Clone, Debug, Default, serde::Serialize)]
    pub(crate) struct Stats {
        pub(crate) hits: u64,
        pub(crate) beams: u64,
        pub(crate) evaluations: u64,
        pub(crate) primary_seconds: f64,
        pub(crate) shadow_seconds: f64,
        pub(crate) seconds: f64,
        pub(crate) classes: BTreeMap<&'static str, u64>,
    }

    /// All planes of a picture.
    pub(crate) struct Frame {
        pub(crate) planes: Planes,
    }

    /// A picture in the making.
    pub(crate) struct Renderer {
        spec: RenderSpec,
        row: usize,
        light: f64,
        stats: Stats,
    }

    impl Renderer {
        /// Prepares a picture.
        pub(crate) fn new(_scene: Scene, spec: RenderSpec, _run: RunSpec) -> anyhow::Result<Self> {
            let light = spec.light_scale + spec.offset.unwrap_or(0.0) + f64::from(u8::from(spec.floor));
            let light = light + (spec.grid as u64 + spec.seed) as f64;
            Ok(Self { spec, row: 0, light, stats: Stats::default() })
        }

        /// Works for about `budget`; true where the picture is complete.
        pub(crate) fn refine(&mut self, budget: Duration) -> bool {
            let start = Instant::now();
            while self.row < self.spec.height && start.elapsed() < budget {
                for _ in 0..self.spec.width {
                    self.stats.hits += 1;
                    self.stats.beams += (self.spec.sub_beams * self.spec.sub_beams) as u64;
                    for i in 0..self.spec.sub_beams * self.spec.sub_beams {
                        self.light = (self.light + i as f64).sqrt().sin();
                        self.stats.evaluations += 1;
                    }
                }
                self.row += 1;
            }
            self.stats.shadow_seconds += start.elapsed().as_secs_f64();
            self.stats.seconds = self.stats.shadow_seconds + self.stats.primary_seconds;
            self.stats.classes = BTreeMap::from([("dark", 0), ("lit", self.stats.hits), ("partly", 0)]);
            self.row == self.spec.height
        }

        /// The part of the work that is done, in [0, 1].
        pub(crate) fn progress(&self) -> f64 {
            self.row as f64 / self.spec.height as f64
        }

        /// The picture as far as it is known.
        pub(crate) fn frame(&self) -> anyhow::Result<Frame> {
            let (w, h) = (self.spec.width, self.spec.height);
            let rgb: Vec<f32> = (0..w * h * 3).map(|i| (i / 3 % w) as f32 / w as f32).collect();
            let mut planes = Planes::new();
            planes.add(Plane::with_channels(COLOR_PLANE, h, w, 3, rgb)?)?;
            planes.add(Plane::new("verdict", h, w, vec![1u8; w * h])?)?;
            planes.add(Plane::new("t_lo", h, w, vec![0.1; w * h])?.rounded(Rounding::Down))?;
            Ok(Frame { planes })
        }

        /// Counters and times so far.
        pub(crate) fn stats(&self) -> Stats {
            self.stats.clone()
        }
    }
}

/// Stand-in of the heart's `paper`.
pub(crate) mod paper {
    use std::time::Duration;

    use antumbra::image::Planes;

    use super::{
        render::{RenderSpec, Renderer, RunSpec},
        scene,
    };
    use crate::args::Exhibit;

    /// What an exhibit consists of.
    pub(crate) struct Report {
        /// Markdown.
        pub(crate) text: String,
        /// Pictures by file name without extension.
        pub(crate) pictures: Vec<(String, Planes)>,
    }

    /// Computes an exhibit, telling `progress` the fraction done.
    pub(crate) fn report(
        exhibit: Exhibit,
        spec: &RenderSpec,
        run: &RunSpec,
        progress: &mut dyn FnMut(f64),
    ) -> anyhow::Result<Report> {
        let mut renderer = Renderer::new(scene::Scene, spec.clone(), run.clone())?;
        while !renderer.refine(Duration::from_millis(100)) {
            progress(renderer.progress());
        }
        let text = format!("# {exhibit:?}\n");
        let pictures = match exhibit {
            Exhibit::Table1 => vec![],
            other => vec![(format!("{other:?}").to_lowercase(), renderer.frame()?.planes)],
        };
        Ok(Report { text, pictures })
    }
}

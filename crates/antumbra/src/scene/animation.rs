//! A scene that moves: parameters that run from one value to another, a camera that goes around.
use super::{ClipEntry, FileError, Object, Scene, SceneFile, View};
use crate::geom::{Box3, Clip, Vec3};
use rayon::prelude::*;

/// A parameter and the values between which it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Its name.
    pub name: String,
    /// Value in the first frame.
    pub from: f64,
    /// Value at the other end.
    pub to: f64,
}

/// How parameters run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Course {
    /// From one end to the other, both included.
    #[default]
    Once,
    /// There and back again: the last frame is the one before the first.
    Back,
    /// The other end *is* the beginning (an angle of a full turn), so it is left out.
    Around,
}

impl Course {
    /// Where frame `k` of `frames` is, 0 at one end and 1 at the other.
    #[must_use]
    pub fn place(self, k: usize, frames: usize) -> f64 {
        let (k, n) = (k as f64, frames as f64);
        match self {
            Self::Once if frames < 2 => 0.0,
            Self::Once => k / (n - 1.0),
            Self::Back => 1.0 - (1.0 - 2.0 * k / n).abs(),
            Self::Around => k / n,
        }
    }
}

/// The frames of a moving scene. Everything that is chosen to fit a scene (clips, camera, lights, floor) is chosen once, to
/// fit all frames: only what moves moves.
#[derive(Clone, Debug)]
pub struct Animation {
    still: Scene,
    /// The file and the name of a scene whose parameters move.
    file: Option<(SceneFile, String)>,
    motions: Vec<Motion>,
    course: Course,
    turntable: bool,
    frames: usize,
}

impl Animation {
    /// Most frames.
    pub const MOST: usize = 100_000;

    /// A scene that is seen from all around, in `frames` steps of one turn around the vertical axis through the camera's
    /// target, beginning where the camera is.
    ///
    /// # Errors
    /// [`FileError::Value`] where the camera stands on that axis, or the number of frames is not 1 to [`Self::MOST`].
    pub fn turntable(scene: Scene, frames: usize) -> Result<Self, FileError> {
        check_frames(frames)?;
        let View { eye, target, .. } = scene.view;
        if (eye[0], eye[1]) == (target[0], target[1]) {
            let reason = "the camera looks along the vertical axis: going around it would change nothing";
            return Err(FileError::Value { key: "camera".to_owned(), reason: reason.to_owned() });
        }
        Ok(Self { still: scene, file: None, motions: vec![], course: Course::Once, turntable: true, frames })
    }

    /// A scene whose parameters move, all at the same time. Looks at every frame, to find what fits all of them.
    ///
    /// # Errors
    /// Those of [`SceneFile::set`] and [`SceneFile::scene`], for any of the frames; [`FileError::Value`] where nothing moves,
    /// one parameter twice, or the number of frames is not 1 to [`Self::MOST`].
    pub fn new(
        mut file: SceneFile,
        name: &str,
        motions: Vec<Motion>,
        course: Course,
        frames: usize,
    ) -> Result<Self, FileError> {
        check_frames(frames)?;
        let refuse = |key: &str, reason: &str| Err(FileError::Value { key: key.to_owned(), reason: reason.to_owned() });
        if motions.is_empty() {
            return refuse("animation", "nothing moves");
        }
        for (k, motion) in motions.iter().enumerate() {
            if motions[..k].iter().any(|m| m.name == motion.name) {
                return refuse(&format!("parameters.{}", motion.name), "it is moved twice");
            }
            // Both ends: a range has no holes.
            for value in [motion.from, motion.to] {
                file.clone().set(&motion.name, value)?;
            }
        }
        let scene_of = |file: &SceneFile, k: usize| {
            let mut file = file.clone();
            set(&mut file, &motions, course.place(k, frames))?;
            file.scene(name)
        };
        let automatic = file.surface.iter().any(|s| s.clip.is_none());
        let framed = file.camera.is_some_and(|c| c.eye.is_some() && (c.angle.is_some() || c.width.is_some()));
        let mut whole = true;
        if automatic {
            let scenes: Vec<Scene> =
                (0..frames).into_par_iter().map(|k| scene_of(&file, k)).collect::<Result<_, _>>()?;
            for (k, entry) in file.surface.iter_mut().enumerate().filter(|(_, entry)| entry.clip.is_none()) {
                let clips = scenes.iter().map(|scene| scene.objects[k].clip());
                let hull = clips.map(|clip| clip.bounds()).reduce(Box3::hull);
                entry.clip = hull.map(|b| corners(&b));
            }
            let uncut = |o: &Object| o.region() != o.clip() || o.clip() == Clip::Everywhere;
            whole = scenes.iter().all(|scene| scene.objects.iter().all(uncut));
        }
        let mut still = scene_of(&file, 0)?;
        if automatic && !framed && !whole {
            // Somewhere a clip cuts a surface off, which an automatic camera leaves more room for.
            let wider = (0..frames).into_par_iter().map(|k| Ok(scene_of(&file, k)?.view));
            let views: Vec<View> = wider.collect::<Result<_, FileError>>()?;
            still.view = views.into_iter().fold(still.view, |a, b| if b.fov_deg > a.fov_deg { b } else { a });
        }
        let file = Some((file, name.to_owned()));
        Ok(Self { still, file, motions, course, turntable: false, frames })
    }

    /// The same, seen from all around.
    ///
    /// # Errors
    /// As for [`Animation::turntable`].
    pub fn turning(self) -> Result<Self, FileError> {
        let turned = Self::turntable(self.still.clone(), self.frames)?;
        Ok(Self { turntable: turned.turntable, ..self })
    }

    /// How many frames there are.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// The scene of frame `k`, from 0.
    ///
    /// # Errors
    /// Those of [`SceneFile::scene`], where parameters move.
    pub fn frame(&self, k: usize) -> Result<Scene, FileError> {
        let mut scene = match &self.file {
            None => self.still.clone(),
            Some((file, name)) => {
                let mut file = file.clone();
                set(&mut file, &self.motions, self.course.place(k, self.frames))?;
                file.scene(name)?
            }
        };
        scene.view = self.still.view;
        if self.turntable {
            scene.view.eye = around(scene.view, k as f64 / self.frames as f64);
        }
        Ok(scene)
    }
}

fn check_frames(frames: usize) -> Result<(), FileError> {
    if (1..=Animation::MOST).contains(&frames) {
        return Ok(());
    }
    let reason = format!("there must be 1 to {} of them, not {frames}", Animation::MOST);
    Err(FileError::Value { key: "frames".to_owned(), reason })
}

fn set(file: &mut SceneFile, motions: &[Motion], place: f64) -> Result<(), FileError> {
    // The ends exactly: their sum could be off by a bit, and out of the range.
    let at = |m: &Motion| match place {
        1.0 => m.to,
        _ => m.from + (m.to - m.from) * place,
    };
    motions.iter().try_for_each(|m| file.set(&m.name, at(m).clamp(m.from.min(m.to), m.from.max(m.to))))
}

fn corners(b: &Box3) -> ClipEntry {
    ClipEntry { min: Some(b.0.map(|x| x.lo())), max: Some(b.0.map(|x| x.hi())), ..ClipEntry::default() }
}

/// Where the camera stands after that share of a turn, counter-clockwise as seen from above.
fn around(view: View, turn: f64) -> Vec3 {
    if turn == 0.0 {
        return view.eye;
    }
    let angle = std::f64::consts::TAU * turn;
    let (sin, cos) = (core_math::sin(angle), core_math::cos(angle));
    let arm = view.eye - view.target;
    view.target + Vec3::new(cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1], arm[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::preset;

    fn motion(name: &str, from: f64, to: f64) -> Motion {
        Motion { name: name.to_owned(), from, to }
    }

    #[test]
    fn courses_begin_and_end_where_they_should() {
        let places = |course: Course, n: usize| (0..n).map(|k| course.place(k, n)).collect::<Vec<_>>();
        assert_eq!(places(Course::Once, 5), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(places(Course::Back, 4), [0.0, 0.5, 1.0, 0.5]);
        assert_eq!(places(Course::Around, 4), [0.0, 0.25, 0.5, 0.75]);
        assert_eq!([Course::Once, Course::Back, Course::Around].map(|c| places(c, 1)[0]), [0.0; 3]);
    }

    #[test]
    fn everything_but_the_motion_stands_still() {
        let file = SceneFile::of_formula("a = 1; x^2 + y^2/a^2 + z^2 = 1");
        let moves = vec![motion("a", 0.5, 2.0)];
        let animation = Animation::new(file, "ball", moves, Course::Once, 7).unwrap();
        let scenes: Vec<Scene> = (0..7).map(|k| animation.frame(k).unwrap()).collect();
        for scene in &scenes {
            assert_eq!((scene.view, scene.lights[0]), (scenes[0].view, scenes[0].lights[0]));
            assert_eq!(
                (scene.objects[0].clip(), scene.floor_height),
                (scenes[0].objects[0].clip(), scenes[0].floor_height)
            );
        }
        // The clip holds the largest.
        let bounds = scenes[0].objects[0].clip().bounds();
        assert!(bounds[1].hi() >= 2.0 && bounds[1].hi() < 2.5 && bounds[0].hi() < 1.5, "{bounds:?}");
        assert!(scenes[0].objects[0].text.contains("a = (0.5)") && scenes[6].objects[0].text.contains("a = (2.0)"));
    }

    #[test]
    fn the_camera_leaves_room_where_one_frame_is_cut_off() {
        // An ellipsoid that opens into a cylinder.
        let file = SceneFile::of_formula("a = 1; x^2 + y^2 + a z^2 = 1");
        let opening = Animation::new(file.clone(), "s", vec![motion("a", 1.0, 0.0)], Course::Once, 5).unwrap();
        let views: Vec<View> = (0..5).map(|k| opening.frame(k).unwrap().view).collect();
        assert!(views.iter().all(|v| *v == views[0]));
        let mut last = file;
        last.set("a", 0.0).unwrap();
        assert!(views[0].fov_deg >= last.scene("s").unwrap().view.fov_deg - 1.0);
    }

    #[test]
    fn a_turntable_keeps_distance_and_height_and_closes() {
        let scene = preset("chubs").unwrap().unwrap();
        let view = scene.view;
        let animation = Animation::turntable(scene, 8).unwrap();
        for k in 0..8 {
            let eye = animation.frame(k).unwrap().view.eye;
            assert_eq!(eye[2], view.eye[2]);
            assert!(((eye - view.target).length() - (view.eye - view.target).length()).abs() < 1e-12);
        }
        assert_eq!(animation.frame(0).unwrap().view.eye, view.eye);
        let opposite = animation.frame(4).unwrap().view.eye;
        assert!((opposite[0] + view.eye[0]).abs() < 1e-12 && (opposite[1] + view.eye[1]).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_move_is_refused() {
        let file = SceneFile::parse(
            "[parameters]\na = { value = 1, min = 0.5, max = 2 }\n[[surface]]\nformula = \"x^2 + y^2 + z^2 = a\"",
        )
        .unwrap();
        let refused = |moves: Vec<Motion>, frames| {
            Animation::new(file.clone(), "s", moves, Course::Once, frames).unwrap_err().to_string()
        };
        assert_eq!(refused(vec![motion("a", 1.0, 3.0)], 4), "parameters.a: 3 is not between 0.5 and 2");
        assert!(refused(vec![motion("b", 1.0, 2.0)], 4).contains("did you mean `a`?"));
        assert!(refused(vec![motion("a", 1.0, 2.0), motion("a", 1.0, 2.0)], 4).contains("moved twice"));
        assert!(refused(vec![motion("a", 1.0, 2.0)], 0).contains("1 to 100000 of them, not 0"));
        assert!(refused(vec![], 4).contains("nothing moves"));
        let mut above = preset("chubs").unwrap().unwrap();
        above.view.eye = Vec3::new(0.0, 0.0, 5.0);
        assert!(Animation::turntable(above, 4).unwrap_err().to_string().contains("vertical axis"));
    }
}

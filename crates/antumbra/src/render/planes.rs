//! A frame as named planes, ready for files.
use super::{Frame, LightPlanes};
use crate::image::{COLOR_PLANE, Error, Plane, Planes, Rounding, Samples};

impl Frame {
    /// All planes of the frame under their field names, those of the second light with `_2` appended and so on, row 0 at the top: `rgb` and `normal` of shape (rows, columns,
    /// 3), the others of shape (rows, columns). A bound stays a bound where a file holds only `f32`: `t_lo` and
    /// `visible_lo` are rounded down, `t_hi` and `visible_hi` up. Copies every plane.
    ///
    /// # Errors
    /// None for a frame whose planes have the lengths that [`Frame::new`] gave them; the type is that of planes.
    pub fn planes(&self) -> Result<Planes, Error> {
        let mut planes = Planes::new();
        let flat = |v: &[[f32; 3]]| v.iter().flatten().copied().collect::<Vec<f32>>();
        let mut add = |name: &str, channels: usize, samples: Samples, rounding: Rounding| {
            let plane = Plane::with_channels(name, self.height, self.width, channels, samples)?;
            planes.add(plane.rounded(rounding))
        };
        add(COLOR_PLANE, 3, flat(&self.rgb).into(), Rounding::Nearest)?;
        add("verdict", 1, self.verdict.clone().into(), Rounding::Nearest)?;
        add("t_lo", 1, self.t_lo.clone().into(), Rounding::Down)?;
        add("t_hi", 1, self.t_hi.clone().into(), Rounding::Up)?;
        add("normal", 3, flat(&self.normal).into(), Rounding::Nearest)?;
        for (k, light) in self.lights.iter().enumerate() {
            let named = |name| name_of(name, k);
            add(&named("visible_lo"), 1, light.visible_lo.clone().into(), Rounding::Down)?;
            add(&named("visible_hi"), 1, light.visible_hi.clone().into(), Rounding::Up)?;
            add(&named("facing"), 1, light.facing.clone().into(), Rounding::Nearest)?;
            let occluded: Vec<u8> = light.initial_occluded.iter().map(|o| u8::from(*o)).collect();
            add(&named("initial_occluded"), 1, occluded.into(), Rounding::Nearest)?;
        }
        add("coverage_lo", 1, self.coverage_lo.clone().into(), Rounding::Down)?;
        add("coverage_hi", 1, self.coverage_hi.clone().into(), Rounding::Up)?;
        add("cost", 1, self.cost.clone().into(), Rounding::Nearest)?;
        Ok(planes)
    }

    /// Names of all planes of a frame under that many lights, in the order of [`Frame::planes`].
    #[must_use]
    pub fn plane_names(lights: usize) -> Vec<String> {
        let own = ["rgb", "verdict", "t_lo", "t_hi", "normal"].map(str::to_owned).into_iter();
        let of_light = |k| ["visible_lo", "visible_hi", "facing", "initial_occluded"].map(|name| name_of(name, k));
        let last = ["coverage_lo", "coverage_hi", "cost"].map(str::to_owned);
        own.chain((0..lights).flat_map(of_light)).chain(last).collect()
    }

    /// The frame whose planes these are.
    ///
    /// # Errors
    /// [`Error::Missing`] and [`Error::Decode`] where a plane is missing or has another type or shape than
    /// [`Frame::planes`] gives it.
    pub fn from_planes(planes: &Planes, lights: usize) -> Result<Self, Error> {
        let verdict = planes.require("verdict")?;
        let (width, height) = (verdict.columns(), verdict.rows());
        let bytes = |name: &str| match planes.require(name)?.samples() {
            Samples::U8(v) if v.len() == width * height => Ok(v.clone()),
            _ => Err(unlike(name, "u8")),
        };
        let doubles = |name: &str| match planes.require(name)?.samples() {
            Samples::F64(v) if v.len() == width * height => Ok(v.clone()),
            _ => Err(unlike(name, "f64")),
        };
        let floats = |name: &str, channels: usize| match planes.require(name)?.samples() {
            Samples::F32(v) if v.len() == width * height * channels => Ok(v.clone()),
            _ => Err(unlike(name, "f32")),
        };
        let triples =
            |name: &str| Ok::<_, Error>(floats(name, 3)?.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect());
        let light = |k: usize| {
            Ok(LightPlanes {
                visible_lo: doubles(&name_of("visible_lo", k))?,
                visible_hi: doubles(&name_of("visible_hi", k))?,
                facing: floats(&name_of("facing", k), 1)?,
                initial_occluded: bytes(&name_of("initial_occluded", k))?.iter().map(|o| *o != 0).collect(),
            })
        };
        Ok(Self {
            width,
            height,
            verdict: bytes("verdict")?,
            t_lo: doubles("t_lo")?,
            t_hi: doubles("t_hi")?,
            normal: triples("normal")?,
            lights: (0..lights).map(light).collect::<Result<_, Error>>()?,
            coverage_lo: doubles("coverage_lo")?,
            coverage_hi: doubles("coverage_hi")?,
            cost: match planes.require("cost")?.samples() {
                Samples::U32(v) if v.len() == width * height => v.clone(),
                _ => return Err(unlike("cost", "u32")),
            },
            rgb: triples(COLOR_PLANE)?,
        })
    }
}

/// Name of a plane of light number `k`: the second light's end in `_2`, and so on.
fn name_of(name: &str, k: usize) -> String {
    if k == 0 { name.to_owned() } else { format!("{name}_{}", k + 1) }
}

fn unlike(name: &str, wanted: &str) -> Error {
    let reason = format!("one {wanted} per pixel (three for colours and normals) is needed");
    Error::Decode { name: name.to_owned(), reason }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_plane_is_there_and_bounds_stay_bounds() {
        let mut frame = Frame::new(3, 2, 2).unwrap();
        frame.t_lo[5] = 0.1;
        frame.t_hi[5] = 0.1;
        frame.rgb[4] = [1.0, 2.0, 3.0];
        let planes = frame.planes().unwrap();
        let names: Vec<&str> = planes.iter().map(Plane::name).collect();
        let wanted = "rgb verdict t_lo t_hi normal visible_lo visible_hi facing initial_occluded visible_lo_2 visible_hi_2 \
             facing_2 initial_occluded_2 coverage_lo coverage_hi cost";
        assert_eq!(names, wanted.split(' ').collect::<Vec<_>>());
        assert_eq!(names, Frame::plane_names(2));
        let back = Frame::from_planes(&planes, 2).unwrap();
        assert_eq!((&back.rgb, back.t_lo[5], back.lights.len()), (&frame.rgb, 0.1, 2));
        assert!(matches!(Frame::from_planes(&planes, 3), Err(Error::Missing(_))));
        let rounding = |name: &str| planes.require(name).unwrap().rounding();
        assert_eq!((rounding("t_lo"), rounding("t_hi")), (Rounding::Down, Rounding::Up));
        assert_eq!((rounding("visible_lo"), rounding("visible_hi")), (Rounding::Down, Rounding::Up));
        assert_eq!(planes.require("rgb").unwrap().shape(), [2, 3, 3]);
        let Samples::F32(rgb) = planes.require("rgb").unwrap().samples() else { panic!("single precision") };
        assert_eq!(rgb[12..15], [1.0, 2.0, 3.0]);
    }
}

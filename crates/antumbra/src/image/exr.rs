//! `.exr`: every plane in one file, for compositing programs and for measuring.

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer, LayerAttributes, SmallVec, Text,
    WritableImage,
};

use super::{COLOR_PLANE, Error, Plane, Planes, SOFTWARE, Samples};

/// The bytes of an OpenEXR file with one layer, losslessly compressed.
///
/// The plane `rgb` becomes the channels `R`, `G`, `B` in linear light, which every program shows as the picture. A
/// plane `p` of one channel becomes the channel `p`; one of three becomes `p.X`, `p.Y`, `p.Z`; others `p.0`, `p.1`, ...
///
/// EXR holds `f32` and `u32`: `f64` goes to `f32` by the plane's [`Rounding`](super::Rounding), so that bounds stay
/// bounds; `u64` goes to `u32` where all of the plane fits, else to the nearest `f32`.
///
/// # Errors
/// [`Error::Missing`] where there is no `rgb` plane, [`Error::NotColor`] where it is not one, [`Error::Encode`] where
/// the encoder refuses.
pub fn exr_bytes(planes: &Planes) -> Result<Vec<u8>, Error> {
    let picture = planes.require(COLOR_PLANE)?;
    if picture.channels() != 3 || !matches!(picture.samples(), Samples::F32(_) | Samples::F64(_)) {
        return Err(Error::NotColor(COLOR_PLANE.to_owned()));
    }
    let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = planes.iter().flat_map(channels).collect();
    let attributes = LayerAttributes { software_name: Text::new_or_none(SOFTWARE), ..LayerAttributes::default() };
    let size = (picture.columns(), picture.rows());
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels));
    let image = Image::new(ImageAttributes::with_size(size), layer);
    let mut bytes = std::io::Cursor::new(Vec::new());
    image
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|e| Error::Encode { format: "EXR", reason: e.to_string() })?;
    Ok(bytes.into_inner())
}

fn channels(plane: &Plane) -> Vec<AnyChannel<FlatSamples>> {
    let count = plane.channels();
    (0..count)
        .map(|k| {
            let name = match (plane.name(), count) {
                (COLOR_PLANE, 3) => ["R", "G", "B"][k].to_owned(),
                (name, 1) => name.to_owned(),
                (name, 3) => format!("{name}.{}", ["X", "Y", "Z"][k]),
                (name, _) => format!("{name}.{k}"),
            };
            AnyChannel::new(&*name, one_channel(plane, k))
        })
        .collect()
}

/// Channel `k` of a plane, in the number types of EXR.
fn one_channel(plane: &Plane, k: usize) -> FlatSamples {
    fn pick<T: Copy, U>(values: &[T], k: usize, step: usize, to: impl Fn(T) -> U) -> Vec<U> {
        values.iter().skip(k).step_by(step).map(|&x| to(x)).collect()
    }
    let step = plane.channels();
    match plane.samples() {
        Samples::F64(v) => FlatSamples::F32(pick(v, k, step, |x| plane.rounding().narrow(x))),
        Samples::F32(v) => FlatSamples::F32(pick(v, k, step, |x| x)),
        Samples::U64(v) if v.iter().all(|&x| u32::try_from(x).is_ok()) => {
            FlatSamples::U32(pick(v, k, step, |x| x as u32))
        }
        Samples::U64(v) => FlatSamples::F32(pick(v, k, step, |x| x as f32)),
        Samples::U32(v) => FlatSamples::U32(pick(v, k, step, |x| x)),
        Samples::U16(v) => FlatSamples::U32(pick(v, k, step, u32::from)),
        Samples::U8(v) => FlatSamples::U32(pick(v, k, step, u32::from)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Rounding;
    use exr::prelude::{ReadChannels, ReadLayers, read};

    fn frame() -> Planes {
        let mut planes = Planes::new();
        let rgb: Vec<f32> = (0..18).map(|i| i as f32 / 3.0).collect();
        let t = vec![0.1, f64::NAN, 3.0, 4.0, 5.0, 6.0];
        for plane in [
            Plane::with_channels(COLOR_PLANE, 2, 3, 3, rgb).unwrap(),
            Plane::new("t_lo", 2, 3, t.clone()).unwrap().rounded(Rounding::Down),
            Plane::new("t_hi", 2, 3, t).unwrap().rounded(Rounding::Up),
            Plane::with_channels("normal", 2, 3, 3, (0..18).map(f64::from).collect::<Vec<_>>()).unwrap(),
            Plane::new("verdict", 2, 3, vec![0u8, 1, 2, 3, 4, 255]).unwrap(),
            Plane::new("cost", 2, 3, vec![7u64; 6]).unwrap(),
            Plane::new("big", 2, 3, vec![1u64 << 40; 6]).unwrap(),
        ] {
            planes.add(plane).unwrap();
        }
        planes
    }

    #[test]
    fn every_plane_is_read_back_under_its_name() {
        let bytes = exr_bytes(&frame()).unwrap();
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(std::io::Cursor::new(bytes))
            .unwrap();
        let layer = &image.layer_data;
        assert_eq!((layer.size.width(), layer.size.height()), (3, 2));
        assert_eq!(layer.attributes.software_name.as_ref().unwrap().to_string(), SOFTWARE);
        let get =
            |name: &str| &layer.channel_data.list.iter().find(|c| c.name.to_string() == name).expect(name).sample_data;
        let floats = |name: &str| match get(name) {
            FlatSamples::F32(v) => v.clone(),
            other => panic!("{name}: {other:?}"),
        };
        assert_eq!(floats("G"), [1.0, 4.0, 7.0, 10.0, 13.0, 16.0].map(|x| x / 3.0f32));
        assert_eq!(floats("normal.Z"), [2.0, 5.0, 8.0, 11.0, 14.0, 17.0]);
        let (lo, hi) = (floats("t_lo"), floats("t_hi"));
        assert!(f64::from(lo[0]) < 0.1 && 0.1 < f64::from(hi[0]) && lo[0].next_up() == hi[0]);
        assert!(lo[1].is_nan() && lo[2] == 3.0 && hi[2] == 3.0);
        assert_eq!(get("verdict"), &FlatSamples::U32(vec![0, 1, 2, 3, 4, 255]));
        assert_eq!(get("cost"), &FlatSamples::U32(vec![7; 6]));
        assert_eq!(floats("big"), [1.099_511_6e12; 6]);
    }

    #[test]
    fn a_picture_is_required() {
        assert!(matches!(exr_bytes(&Planes::new()), Err(Error::Missing(_))));
    }
}

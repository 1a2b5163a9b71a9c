//! `.npy`: one plane with its element type and shape, as `numpy.load` reads it.

use npyz::{AutoSerialize, DType, NpyFile, Order, TypeChar, WriteOptions, WriterBuilder};

use super::{Error, Plane, Samples};

/// The bytes of a `.npy` file: shape [`Plane::shape`], C order, little endian, row 0 at the top.
///
/// # Errors
/// [`Error::Encode`] where the encoder refuses, which no plane is known to cause.
pub fn npy_bytes(plane: &Plane) -> Result<Vec<u8>, Error> {
    match plane.samples() {
        Samples::F64(v) => write(plane, v),
        Samples::F32(v) => write(plane, v),
        Samples::U64(v) => write(plane, v),
        Samples::U32(v) => write(plane, v),
        Samples::U16(v) => write(plane, v),
        Samples::U8(v) => write(plane, v),
    }
}

/// The bytes before the elements in the `.npy` file of a plane like this one with that many rows: for planes that are written row by row.
///
/// # Errors
/// As for [`npy_bytes`].
pub fn npy_header(plane: &Plane, rows: usize) -> Result<Vec<u8>, Error> {
    let mut shape = plane.shape();
    shape[0] = rows;
    match plane.samples() {
        Samples::F64(_) => header::<f64>(&shape),
        Samples::F32(_) => header::<f32>(&shape),
        Samples::U64(_) => header::<u64>(&shape),
        Samples::U32(_) => header::<u32>(&shape),
        Samples::U16(_) => header::<u16>(&shape),
        Samples::U8(_) => header::<u8>(&shape),
    }
}

/// The plane in the bytes of a `.npy` file as [`npy_bytes`] writes it, under the given name.
///
/// # Errors
/// [`Error::Decode`] where the bytes are no such file, and the errors of [`Plane::with_channels`].
pub fn plane_from_npy(name: &str, bytes: &[u8]) -> Result<Plane, Error> {
    let refuse = |reason: String| Error::Decode { name: name.to_owned(), reason };
    let file = NpyFile::new(bytes).map_err(|e| refuse(e.to_string()))?;
    let shape: Vec<usize> = file.shape().iter().map(|&n| n as usize).collect();
    let (rows, columns, channels) = match shape[..] {
        [rows, columns] => (rows, columns, 1),
        [rows, columns, channels] => (rows, columns, channels),
        _ => return Err(refuse(format!("its shape is {shape:?}; two or three dimensions are needed"))),
    };
    if file.order() != Order::C {
        return Err(refuse("its order is not C".to_owned()));
    }
    let DType::Plain(kind) = file.dtype() else { return Err(refuse("its elements are not numbers".to_owned())) };
    let samples = match (kind.type_char(), kind.size_field()) {
        (TypeChar::Float, 8) => file.into_vec::<f64>().map(Samples::F64),
        (TypeChar::Float, 4) => file.into_vec::<f32>().map(Samples::F32),
        (TypeChar::Uint, 8) => file.into_vec::<u64>().map(Samples::U64),
        (TypeChar::Uint, 4) => file.into_vec::<u32>().map(Samples::U32),
        (TypeChar::Uint, 2) => file.into_vec::<u16>().map(Samples::U16),
        (TypeChar::Uint, 1) => file.into_vec::<u8>().map(Samples::U8),
        _ => return Err(refuse(format!("elements of type {kind} are not used here"))),
    };
    Plane::with_channels(name, rows, columns, channels, samples.map_err(|e| refuse(e.to_string()))?)
}

fn header<T: AutoSerialize>(shape: &[usize]) -> Result<Vec<u8>, Error> {
    let shape: Vec<u64> = shape.iter().map(|&n| n as u64).collect();
    let mut bytes = Vec::new();
    let begun = WriteOptions::<T>::new().default_dtype().shape(&shape).writer(&mut bytes).begin_nd();
    begun.map_err(|e| Error::Encode { format: ".npy", reason: e.to_string() })?;
    Ok(bytes)
}

fn write<T: AutoSerialize + Copy>(plane: &Plane, values: &[T]) -> Result<Vec<u8>, Error> {
    let shape: Vec<u64> = plane.shape().iter().map(|&n| n as u64).collect();
    let mut bytes = Vec::with_capacity(256 + size_of_val(values));
    let mut encode = || {
        let mut writer = WriteOptions::new().default_dtype().shape(&shape).writer(&mut bytes).begin_nd()?;
        writer.extend(values.iter().copied())?;
        writer.finish()
    };
    encode().map_err(|e| Error::Encode { format: ".npy", reason: e.to_string() })?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let normal: Vec<f64> = (0..2 * 5 * 3).map(|i| f64::from(i) / 7.0).collect();
        let plane = Plane::with_channels("normal", 2, 5, 3, normal.clone()).unwrap();
        let bytes = npy_bytes(&plane).unwrap();
        let file = NpyFile::new(&bytes[..]).unwrap();
        assert_eq!(file.shape(), [2, 5, 3]);
        assert_eq!(file.order(), Order::C);
        assert_eq!(file.into_vec::<f64>().unwrap(), normal);

        assert_eq!(plane_from_npy("normal", &bytes).unwrap(), plane);
        assert!(bytes.starts_with(&npy_header(&plane, 2).unwrap()));
        let taller = Plane::with_channels("normal", 3, 5, 3, vec![0.5; 45]).unwrap();
        let header = npy_header(&plane, 3).unwrap();
        assert_eq!(npy_bytes(&taller).unwrap().strip_prefix(&header[..]).unwrap().len(), 45 * 8);
        for cut in [0, 5, bytes.len() - 1] {
            let error = plane_from_npy("normal", &bytes[..cut]).unwrap_err();
            assert!(matches!(error, Error::Decode { .. }), "{cut}: {error}");
        }

        let verdict = Plane::new("verdict", 2, 2, vec![0u8, 1, 2, 255]).unwrap();
        let bytes = npy_bytes(&verdict).unwrap();
        let file = NpyFile::new(&bytes[..]).unwrap();
        assert_eq!(file.shape(), [2, 2]);
        assert_eq!(file.into_vec::<u8>().unwrap(), [0, 1, 2, 255]);
    }

    #[test]
    fn nan_and_infinity_survive() {
        let plane = Plane::new("t_lo", 1, 3, vec![f64::NAN, f64::INFINITY, -0.0]).unwrap();
        let bytes = npy_bytes(&plane).unwrap();
        let back = NpyFile::new(&bytes[..]).unwrap().into_vec::<f64>().unwrap();
        assert!(back[0].is_nan() && back[1] == f64::INFINITY && back[2].to_bits() == (-0.0f64).to_bits());
    }

    #[test]
    fn counters_keep_all_their_bits() {
        let plane = Plane::new("cost", 1, 2, vec![u64::MAX, 1]).unwrap();
        let back = NpyFile::new(&npy_bytes(&plane).unwrap()[..]).unwrap().into_vec::<u64>().unwrap();
        assert_eq!(back, [u64::MAX, 1]);
    }
}

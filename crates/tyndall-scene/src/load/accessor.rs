//! Typed arrays out of buffers. Everything is checked before it is read: the `gltf` crate's own iterators take
//! types, strides and sparse indices on trust.

use gltf::{
    Accessor,
    accessor::{DataType, Dimensions},
    buffer,
};

use super::{
    buffers::Buffers,
    error::{Refusal, broken, called},
};

/// The component types that an attribute may have besides float.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Integers {
    /// None.
    Refused,
    /// Unsigned ones, normalised to [0, 1].
    UnsignedNormalized,
    /// 8 and 16-bit ones, normalised to [0, 1] or [-1, 1].
    Normalized,
    /// 8 and 16-bit ones, normalised or not (`KHR_mesh_quantization`).
    Quantized,
}

/// Reads vectors of `N` floats, all of them finite.
pub(super) fn read_vectors<const N: usize>(
    accessor: &Accessor<'_>,
    buffers: &Buffers<'_>,
    integers: Integers,
) -> Result<Vec<[f32; N]>, Refusal> {
    let place = || called("accessor", accessor.index(), accessor.name());
    check_vector_type::<N>(accessor, integers).map_err(|problem| broken(place(), problem))?;
    let (component, normalized) = (accessor.data_type(), accessor.normalized());
    let size = component.size();
    let decode = |bytes: &[u8]| {
        std::array::from_fn(|i| float_of(&bytes[i * size..][..size], component, normalized))
    };
    let vectors = read_elements(accessor, buffers, decode, [0.0; N])?;
    match vectors
        .iter()
        .position(|v| !v.iter().all(|x| x.is_finite()))
    {
        None => Ok(vectors),
        Some(i) => Err(broken(
            place(),
            format!("element {i} must be finite, found {:?}", vectors[i]),
        )),
    }
}

/// Reads unsigned integers.
pub(super) fn read_indices(
    accessor: &Accessor<'_>,
    buffers: &Buffers<'_>,
) -> Result<Vec<u32>, Refusal> {
    use DataType::{U8, U16, U32};
    let component = accessor.data_type();
    if accessor.dimensions() != Dimensions::Scalar || !matches!(component, U8 | U16 | U32) {
        return Err(broken(
            called("accessor", accessor.index(), accessor.name()),
            format!(
                "indices must be unsigned scalars, found {:?} of {component:?}",
                accessor.dimensions()
            ),
        ));
    }
    read_elements(accessor, buffers, unsigned_of, 0)
}

fn check_vector_type<const N: usize>(
    accessor: &Accessor<'_>,
    integers: Integers,
) -> Result<(), String> {
    let (dimensions, component) = (accessor.dimensions(), accessor.data_type());
    let expected = match N {
        1 => Dimensions::Scalar,
        2 => Dimensions::Vec2,
        4 => Dimensions::Vec4,
        _ => Dimensions::Vec3,
    };
    let component_fits = match component {
        DataType::F32 => true,
        DataType::U32 => false,
        DataType::U8 | DataType::U16 => match integers {
            Integers::Quantized => true,
            Integers::UnsignedNormalized | Integers::Normalized => accessor.normalized(),
            Integers::Refused => false,
        },
        DataType::I8 | DataType::I16 => match integers {
            Integers::Quantized => true,
            Integers::Normalized => accessor.normalized(),
            Integers::UnsignedNormalized | Integers::Refused => false,
        },
    };
    let allowed = match integers {
        Integers::Refused => "F32",
        Integers::UnsignedNormalized => "F32 or normalized U8 or U16",
        Integers::Normalized => "F32 or normalized I8, U8, I16 or U16",
        Integers::Quantized => "F32, I8, U8, I16 or U16",
    };
    if dimensions == expected && component_fits {
        Ok(())
    } else {
        Err(format!(
            "must be {expected:?} of {allowed}, found {dimensions:?} of {component:?}"
        ))
    }
}

/// Reads every element, with the sparse ones put in place.
fn read_elements<T: Copy>(
    accessor: &Accessor<'_>,
    buffers: &Buffers<'_>,
    decode: impl Fn(&[u8]) -> T,
    zero: T,
) -> Result<Vec<T>, Refusal> {
    let place = called("accessor", accessor.index(), accessor.name());
    let (count, size) = (accessor.count(), accessor.size());
    let mut elements = match accessor.view() {
        Some(view) => Elements::new(&view, buffers, accessor.offset(), count, size)
            .map_err(|refusal| refusal.within(&place))?
            .iter()
            .map(&decode)
            .collect(),
        None => {
            buffers
                .claim_zeros(count)
                .map_err(|problem| broken(&place, problem))?;
            vec![zero; count]
        }
    };
    if let Some(sparse) = accessor.sparse() {
        replace_sparse(&mut elements, &sparse, size, buffers, decode)
            .map_err(|refusal| refusal.within(&place))?;
    }
    Ok(elements)
}

fn replace_sparse<T>(
    elements: &mut [T],
    sparse: &gltf::accessor::sparse::Sparse<'_>,
    size: usize,
    buffers: &Buffers<'_>,
    decode: impl Fn(&[u8]) -> T,
) -> Result<(), Refusal> {
    let (indices, values) = (sparse.indices(), sparse.values());
    let index_size = indices.index_type().size();
    let indices = Elements::new(
        &indices.view(),
        buffers,
        indices.offset(),
        sparse.count(),
        index_size,
    )?;
    let values = Elements::new(
        &values.view(),
        buffers,
        values.offset(),
        sparse.count(),
        size,
    )?;
    let count = elements.len();
    for (index, value) in indices.iter().map(unsigned_of).zip(values.iter()) {
        let element = elements.get_mut(index as usize).ok_or_else(|| {
            broken(
                "sparse",
                format!("index {index} is out of range for {count} elements"),
            )
        })?;
        *element = decode(value);
    }
    Ok(())
}

/// Equally long pieces of a view at equal distances, known to lie inside it.
struct Elements<'a> {
    bytes: &'a [u8],
    count: usize,
    stride: usize,
    size: usize,
}

impl<'a> Elements<'a> {
    fn new(
        view: &buffer::View<'_>,
        buffers: &'a Buffers<'_>,
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<Self, Refusal> {
        let bytes = buffers.view(view)?;
        let stride = view.stride().unwrap_or(size);
        let place = || called("bufferView", view.index(), view.name());
        if count == 0 || stride < size {
            return Err(broken(
                place(),
                format!(
                    "must hold at least 1 element and have a stride of at least {size} bytes, found {count} elements {stride} bytes apart"
                ),
            ));
        }
        let end = (count - 1)
            .checked_mul(stride)
            .and_then(|last| last.checked_add(size)?.checked_add(offset));
        let bytes = end.and_then(|end| bytes.get(offset..end)).ok_or_else(|| {
            broken(
                place(),
                format!(
                    "{count} elements of {size} bytes, {stride} bytes apart, from byte {offset} do not fit into its {} bytes",
                    view.length()
                ),
            )
        })?;
        Ok(Self {
            bytes,
            count,
            stride,
            size,
        })
    }

    fn iter(&self) -> impl Iterator<Item = &'a [u8]> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |i| &bytes[i * stride..][..size])
    }
}

/// One component as a float; normalised integers as glTF 2.0, section 3.11, has it.
fn float_of(bytes: &[u8], component: DataType, normalized: bool) -> f32 {
    let (value, largest) = match (component, bytes) {
        (DataType::F32, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
        (DataType::I8, &[a]) => (f32::from(a.cast_signed()), f32::from(i8::MAX)),
        (DataType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), f32::from(i16::MAX)),
        (_, &[a]) => (f32::from(a), f32::from(u8::MAX)),
        (_, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), f32::from(u16::MAX)),
        (_, bytes) => (unsigned_of(bytes) as f32, u32::MAX as f32),
    };
    if normalized {
        (value / largest).max(-1.0)
    } else {
        value
    }
}

/// A little-endian unsigned integer of up to 4 bytes.
fn unsigned_of(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |value, &byte| value << 8 | u32::from(byte))
}

//! Bytes of buffers, of views into them, and of files that URIs refer to.

use std::{
    borrow::Cow,
    cell::{Cell, OnceCell},
    fs,
    path::{Path, PathBuf},
};

use data_url::DataUrl;
use gltf::{Document, buffer};
use percent_encoding::percent_decode_str;

use super::error::{Refusal, broken, called};

/// Most elements of a file's accessors without data of their own (sparse over zeros), so that a few bytes cannot claim
/// gigabytes.
const MAX_ZEROS: usize = 1 << 24;

/// The document's buffers, each loaded when it is first needed.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    glb_chunk: Option<&'a [u8]>,
    folder: PathBuf,
    loaded: Vec<OnceCell<Vec<u8>>>,
    /// Elements that have no data of their own.
    zeros: Cell<usize>,
}

/// An image's file.
pub(super) struct ImageFile<'a> {
    /// The image's name in messages.
    pub(super) place: String,
    /// The file as it is.
    pub(super) bytes: Cow<'a, [u8]>,
}

impl<'a> Buffers<'a> {
    /// `glb_chunk` is the GLB file's BIN chunk; relative URIs are looked up in `folder`.
    pub(super) fn new(
        document: &'a Document,
        glb_chunk: Option<&'a [u8]>,
        folder: Option<&Path>,
    ) -> Self {
        Self {
            document,
            glb_chunk,
            folder: folder.map(Path::to_owned).unwrap_or_default(),
            loaded: vec![OnceCell::new(); document.buffers().len()],
            zeros: Cell::new(0),
        }
    }

    /// Counts elements without data of their own against the file's limit, before anything is allocated for them.
    pub(super) fn claim_zeros(&self, count: usize) -> Result<(), String> {
        let zeros = self.zeros.get().saturating_add(count);
        self.zeros.set(zeros);
        if zeros <= MAX_ZEROS {
            return Ok(());
        }
        Err(format!(
            "brings the file to {zeros} elements without a bufferView, at most {MAX_ZEROS} are supported"
        ))
    }

    /// The bytes of a view.
    pub(super) fn view(&self, view: &buffer::View<'_>) -> Result<&[u8], Refusal> {
        let bytes = self.buffer(view.buffer().index())?;
        view.offset()
            .checked_add(view.length())
            .and_then(|end| bytes.get(view.offset()..end))
            .ok_or_else(|| {
                broken(
                    called("bufferView", view.index(), view.name()),
                    format!(
                        "{} bytes from byte {} lie outside buffer {} of {} bytes",
                        view.length(),
                        view.offset(),
                        view.buffer().index(),
                        bytes.len()
                    ),
                )
            })
    }

    /// A texture's image: in a view, in its URI, or beside the document; `None` if the texture has none.
    pub(super) fn image(
        &self,
        texture: &gltf::Texture<'_>,
    ) -> Result<Option<ImageFile<'_>>, Refusal> {
        // Reads the JSON, because the `gltf` crate panics where `source` or `mimeType` is missing.
        let root = self.document.as_json();
        let index = root.textures[texture.index()].source.value();
        let Some(image) = root.images.get(index) else {
            return Ok(None);
        };
        let place = called("image", index, image.name.as_deref());
        let view = image
            .buffer_view
            .and_then(|view| self.document.views().nth(view.value()));
        let bytes = match (view, &image.uri) {
            (Some(view), _) => self
                .view(&view)
                .map(Cow::Borrowed)
                .map_err(|refusal| refusal.within(&place))?,
            (None, Some(uri)) => self
                .resolve(uri)
                .map(Cow::Owned)
                .map_err(|why| broken(&place, why))?,
            (None, None) => return Err(broken(place, "has neither `uri` nor `bufferView`")),
        };
        Ok(Some(ImageFile { place, bytes }))
    }

    fn buffer(&self, index: usize) -> Result<&[u8], Refusal> {
        let json = &self.document.as_json().buffers[index];
        let place = || called("buffer", index, json.name.as_deref());
        let bytes = match (&json.uri, self.glb_chunk) {
            (Some(uri), _) => match self.loaded[index].get() {
                Some(bytes) => bytes,
                None => {
                    let bytes = self.resolve(uri).map_err(|why| broken(place(), why))?;
                    self.loaded[index].get_or_init(|| bytes)
                }
            },
            (None, Some(chunk)) if index == 0 => chunk,
            (None, _) => {
                return Err(broken(place(), "has no `uri`, and there is no GLB chunk"));
            }
        };
        let length = json.byte_length.0;
        usize::try_from(length)
            .ok()
            .and_then(|length| bytes.get(..length))
            .ok_or_else(|| {
                broken(
                    place(),
                    format!("must have {length} bytes, found {}", bytes.len()),
                )
            })
    }

    fn resolve(&self, uri: &str) -> Result<Vec<u8>, String> {
        match scheme(uri) {
            Some(scheme) if scheme.eq_ignore_ascii_case("data") => decode_data_uri(uri),
            Some(scheme) => Err(format!(
                "URI must be a relative path or `data:`, found `{scheme}:`"
            )),
            None => self.read_file(uri),
        }
    }

    fn read_file(&self, uri: &str) -> Result<Vec<u8>, String> {
        let name = percent_decode_str(uri)
            .decode_utf8()
            .map_err(|_| format!("URI `{uri}` must be UTF-8"))?;
        let path = self.folder.join(name.as_ref());
        let refused =
            |why: &dyn std::fmt::Display| format!("cannot read {}: {why}", path.display());
        // A pipe or a device would block or never end.
        if !fs::metadata(&path).map_err(|e| refused(&e))?.is_file() {
            return Err(refused(&"not a file"));
        }
        fs::read(&path).map_err(|e| refused(&e))
    }
}

/// The part before the first colon, if it looks like RFC 3986's scheme.
fn scheme(uri: &str) -> Option<&str> {
    uri.split_once(':')
        .map(|(scheme, _)| scheme)
        .filter(|scheme| {
            scheme.starts_with(|c: char| c.is_ascii_alphabetic())
                && scheme
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
        })
}

fn decode_data_uri(uri: &str) -> Result<Vec<u8>, String> {
    let refused = |why: &dyn std::fmt::Debug| format!("`data:` URI cannot be decoded: {why:?}");
    let url = DataUrl::process(uri).map_err(|e| refused(&e))?;
    let (bytes, _) = url.decode_to_vec().map_err(|e| refused(&e))?;
    Ok(bytes)
}

//! The pictures of one method: the last whole one, and over it as much of a finer one as is settled.
use crate::worker::Image;
use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};

/// A picture and its texture.
pub(super) struct Picture {
    pub(super) image: Image,
    pub(super) texture: TextureHandle,
}

/// What is seen on one side of the line.
#[derive(Default)]
pub(super) struct Side {
    /// Whole.
    pub(super) base: Option<Picture>,
    /// In part.
    pub(super) fine: Option<Picture>,
}

impl Side {
    /// Takes a picture in.
    pub(super) fn take(&mut self, context: &Context, mut image: Image) {
        // The texture has the colours from here on.
        let rgba = std::mem::take(&mut image.rgba);
        let pixels = rgba.chunks_exact(4).map(|c| Color32::from_rgba_premultiplied(c[0], c[1], c[2], c[3])).collect();
        let colors = ColorImage::new(image.size, pixels);
        // Kinds of an overlay do not mix, and what is not settled must not bleed into what is.
        let smooth = image.legend.is_empty() && image.whole;
        let options = if smooth { TextureOptions::LINEAR } else { TextureOptions::NEAREST };
        let texture = context.load_texture(format!("side {}", image.side), colors, options);
        let whole = image.whole;
        let picture = Some(Picture { image, texture });
        if whole {
            (self.base, self.fine) = (picture, None);
        } else {
            self.fine = picture;
        }
    }

    /// The picture that says most.
    pub(super) fn best(&self) -> Option<&Image> {
        self.fine.as_ref().or(self.base.as_ref()).map(|p| &p.image)
    }
}

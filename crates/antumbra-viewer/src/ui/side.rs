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
    /// Takes a picture in, and gives those that it replaces.
    pub(super) fn take(&mut self, context: &Context, mut image: Image) -> impl Iterator<Item = Image> + use<> {
        // The texture has the colours from here on. Of the same size and alignment, they stay where they lie in memory.
        let rgba = std::mem::take(&mut image.rgba).into_iter().map(u32::to_ne_bytes);
        let pixels = rgba.map(|[r, g, b, a]| Color32::from_rgba_premultiplied(r, g, b, a)).collect();
        let colors = ColorImage::new(image.size, pixels);
        // Kinds of an overlay do not mix, and what is not settled must not bleed into what is.
        let smooth = image.legend.is_empty() && image.whole;
        let options = if smooth { TextureOptions::LINEAR } else { TextureOptions::NEAREST };
        let texture = context.load_texture(format!("side {}", image.side), colors, options);
        let whole = image.whole;
        let picture = Some(Picture { image, texture });
        let old = if whole {
            [std::mem::replace(&mut self.base, picture), self.fine.take()]
        } else {
            [std::mem::replace(&mut self.fine, picture), None]
        };
        old.into_iter().flatten().map(|picture| picture.image)
    }

    /// The picture that says most.
    pub(super) fn best(&self) -> Option<&Image> {
        self.fine.as_ref().or(self.base.as_ref()).map(|p| &p.image)
    }
}

//! When the pixels of a picture get their colours.
use super::{Frame, Renderer};

impl Renderer {
    /// From now on a hit gets its colour when its light is known, and not, as well, when it is found: less work for whoever looks only
    /// at the finished picture or at its [`preview`](Self::preview). Until then it is black. The finished picture is the same.
    pub fn color_late(&mut self) {
        self.late_colors = true;
    }

    /// The frame of an unfinished render with the colours of its edges, as far as they are known: to be looked at. What
    /// was not looked at is black, light that was not looked for is there.
    #[must_use]
    pub fn preview(mut self) -> Frame {
        self.put_missing_colors();
        let rows = self.task.window.finished().start..self.task.window.held().end;
        self.book.finish_colors(&self.task, self.task.indices(rows));
        self.book.frame
    }

    pub(super) fn put_colors(&mut self, pixels: &[usize], lit: bool) {
        let Self { crew, book, task, .. } = self;
        crew.install(|| book.put_colors(task, pixels, lit));
    }

    /// Colours of pixels whose light was not looked for yet. (Without a light in the scene nobody will.)
    pub(super) fn put_first_colors(&mut self, mut pixels: Vec<usize>) {
        if self.late_colors && !self.task.lights.is_empty() {
            pixels.retain(|index| self.book.hit(*index).is_none());
        }
        self.put_colors(&pixels, false);
    }

    /// Colours of hits that wait for theirs.
    pub(super) fn put_missing_colors(&mut self) {
        let frame = &self.book.frame;
        let waits = |index: &usize| self.book.hit(*index).is_some() && frame.rgb[*index] == [0.0; 3];
        let unlit =
            |index: &usize| frame.lights.iter().all(|l| (l.visible_lo[*index], l.visible_hi[*index]) == (0.0, 1.0));
        let pixels: Vec<usize> = (0..frame.rgb.len()).filter(waits).filter(unlit).collect();
        self.put_colors(&pixels, false);
    }
}

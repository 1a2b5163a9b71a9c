//! When the pixels of a picture get their colours.
use super::renderer::Stage;
use super::{Frame, Method, Renderer};

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

    /// Colours of pixels whose light was not looked for yet, but for those that may wait.
    pub(super) fn put_first_colors(&mut self, mut pixels: Vec<usize>) {
        if self.late_colors {
            pixels.retain(|index| !self.awaits_light(*index));
        }
        self.put_colors(&pixels, false);
    }

    /// Whether a pixel shows a hit whose light is looked for: then it gets a colour with it.
    fn awaits_light(&self, index: usize) -> bool {
        let of_paper = self.task.method != Method::Certified;
        let hit = self.book.hit(index);
        !self.task.lights.is_empty() && hit.is_some_and(|hit| of_paper || hit.receiver.is_some())
    }

    /// Colours of hits that still wait for theirs. (What is found black anew is coloured again with the same result, or by its
    /// light, or where brackets are open by what is likely.)
    pub(super) fn put_missing_colors(&mut self) {
        if !matches!(self.stage, Stage::Primary | Stage::Shadow) {
            return;
        }
        let frame = &self.book.frame;
        let black = |index: &usize| frame.rgb[*index] == [0.0; 3] && self.awaits_light(*index);
        let unlit =
            |index: &usize| frame.lights.iter().all(|l| (l.visible_lo[*index], l.visible_hi[*index]) == (0.0, 1.0));
        let pixels: Vec<usize> = self.task.indices(self.task.window.fresh()).filter(black).filter(unlit).collect();
        self.put_colors(&pixels, false);
    }
}

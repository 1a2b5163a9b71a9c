//! The way back, and forth again.

/// Steps that are kept.
const MOST: usize = 200;

/// States that were left.
#[derive(Clone, Debug)]
pub struct History<T> {
    past: Vec<T>,
    future: Vec<T>,
    /// Kind of the step that is not closed yet.
    open: Option<String>,
}

impl<T> Default for History<T> {
    fn default() -> Self {
        Self { past: vec![], future: vec![], open: None }
    }
}

impl<T: Clone> History<T> {
    /// Keeps the state before a change. A change of the same kind as the one before it belongs to the same step; an empty kind does not.
    pub fn push(&mut self, kind: &str, before: T) {
        self.future.clear();
        if self.open.as_deref() == Some(kind) {
            return;
        }
        self.open = (!kind.is_empty()).then(|| kind.to_owned());
        self.past.push(before);
        if self.past.len() > MOST {
            self.past.remove(0);
        }
    }

    /// The next change begins a step.
    pub fn close(&mut self) {
        self.open = None;
    }

    /// The state before the last step.
    pub fn undo(&mut self, now: &T) -> Option<T> {
        self.open = None;
        let before = self.past.pop()?;
        self.future.push(now.clone());
        Some(before)
    }

    /// The state that was taken back.
    pub fn redo(&mut self, now: &T) -> Option<T> {
        self.open = None;
        let after = self.future.pop()?;
        self.past.push(now.clone());
        Some(after)
    }

    /// Whether there is a way back, and one forth.
    #[must_use]
    pub fn ways(&self) -> [bool; 2] {
        [!self.past.is_empty(), !self.future.is_empty()]
    }
}

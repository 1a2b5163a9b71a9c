//! Scenes that are found on threads of their own: reading and building may take a while.
use crate::host::{Found, SharedHost};
use eframe::egui::Context;
use std::sync::mpsc;

/// Answers come with the number of their question; only the newest counts.
pub(super) struct Finder {
    host: SharedHost,
    context: Context,
    asked: u64,
    send: mpsc::Sender<(u64, Result<Found, String>)>,
    answers: mpsc::Receiver<(u64, Result<Found, String>)>,
}

impl Finder {
    pub(super) fn new(host: SharedHost, context: Context) -> Self {
        let (send, answers) = mpsc::channel();
        Self { host, context, asked: 0, send, answers }
    }

    /// Looks for the scene that a text means.
    pub(super) fn ask(&mut self, text: &str) {
        self.asked += 1;
        let (number, send, host) = (self.asked, self.send.clone(), std::sync::Arc::clone(&self.host));
        let (text, context) = (text.to_owned(), self.context.clone());
        let look = move || {
            // The window is gone: nobody waits for the answer.
            let _ = send.send((number, host.find(&text)));
            context.request_repaint();
        };
        let thread = std::thread::Builder::new().name("antumbra-find".to_owned()).spawn(look);
        if let Err(error) = thread {
            let _ = self.send.send((number, Err(format!("there is no thread for it: {error}"))));
        }
    }

    /// The answer to the last question.
    pub(super) fn found(&self) -> Option<Result<Found, String>> {
        self.answers.try_iter().filter(|(number, _)| *number == self.asked).last().map(|(_, found)| found)
    }
}

//! Proof that dispatches were done.
//!
//! Not every driver tells what it left undone (Metal's counts a dispatch that failed as done, and wgpu believes it). Memory that such a
//! dispatch should have written holds what some other one has written: claims about other pixels. So each group of threads has a ticket, a
//! number that no other group of this program has; the last thing that it does is to add the hash of its ticket to a sum in memory, and
//! nothing is believed before that sum is the one of all tickets. A dispatch that was left out, done in part, done twice, or done with the
//! numbers of another one, because those of its own did not arrive, makes another sum (but for 1 case in 2^32). What is uploaded once bears a
//! seal, a number that counts in all hashes (there are 65,535). That what is read back was copied is the driver's word.
use crate::error::Error;
use std::hash::{BuildHasher, RandomState};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// So many numbers in a row that nobody has had, the first of them.
pub(crate) fn tickets(count: u32) -> u32 {
    // Not those of the program that had this memory before.
    static NEXT: OnceLock<AtomicU32> = OnceLock::new();
    let next = NEXT.get_or_init(|| AtomicU32::new(RandomState::new().hash_one(0) as u32));
    next.fetch_add(count, Ordering::Relaxed)
}

/// A seal: not 0, and exact as a float.
pub(crate) fn seal() -> u32 {
    tickets(1) % 0xffff + 1
}

/// What has been handed out.
#[derive(Debug, Default)]
pub(crate) struct Receipts {
    sum: u32,
}

impl Receipts {
    /// Tickets for the groups of a dispatch, which see that seal: the first of them.
    pub(crate) fn hand_out(&mut self, groups: u32, seal: u32) -> u32 {
        let first = tickets(groups);
        let hashes = (0..groups).map(|group| hash(first.wrapping_add(group).wrapping_add(seal)));
        self.sum = hashes.fold(self.sum, u32::wrapping_add);
        first
    }

    /// What to say where something was not done.
    pub(crate) fn missing() -> Error {
        Error::Failed("a part of the work was not done, and its driver did not tell".to_owned())
    }

    /// Whether that is the sum of everybody who got one.
    pub(crate) fn is_sum(&self, found: u32) -> bool {
        found == self.sum
    }
}

/// `hash` of `frame.wgsl`: the finalizer of MurmurHash3, a bijection that spreads every bit.
fn hash(ticket: u32) -> u32 {
    let x = (ticket ^ ticket >> 16).wrapping_mul(0x85eb_ca6b);
    let x = (x ^ x >> 13).wrapping_mul(0xc2b2_ae35);
    x ^ x >> 16
}

#[cfg(test)]
mod tests {
    use super::{Receipts, hash, tickets};

    #[test]
    fn every_ticket_counts_once() {
        let mut receipts = Receipts::default();
        let (a, b) = (receipts.hand_out(1 << 16, 7), receipts.hand_out(1 << 16, 7));
        let sum =
            |first: u32, count: u32| (0..count).map(|k| hash(first.wrapping_add(k + 7))).fold(0, u32::wrapping_add);
        let [a, b] = [a, b].map(|first| (first, sum(first, 1 << 16)));
        assert!(receipts.is_sum(a.1.wrapping_add(b.1)));
        // Left out, done in part, done with the numbers of the other, by others.
        let other = sum(tickets(1 << 16), 1 << 16);
        // Without what was uploaded.
        let without = sum(a.0.wrapping_sub(7), 1 << 16).wrapping_add(sum(b.0.wrapping_sub(7), 1 << 16));
        for wrong in
            [0, a.1, b.1, sum(a.0, 65_535).wrapping_add(b.1), a.1.wrapping_mul(2), other.wrapping_add(b.1), without]
        {
            assert!(!receipts.is_sum(wrong));
        }
    }
}

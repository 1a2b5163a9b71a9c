//! Proof that dispatches were done.
//!
//! Not every driver tells what it left undone (Metal's counts a dispatch that failed as done, and wgpu believes it). Memory that such a
//! dispatch should have written holds what some other one has written: claims about other pixels. So each group of threads has a ticket, a
//! number that no other group of this program has; the last thing that it does is to add the hash of its ticket to a sum in memory, and
//! nothing is believed before that sum is the one of all tickets. A dispatch that was left out, done in part, done twice, or done with the
//! numbers of another one, because those of its own did not arrive, makes another sum (but for 1 case in 2^32).
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

/// What has been handed out.
#[derive(Debug, Default)]
pub(crate) struct Receipts {
    sum: u32,
}

impl Receipts {
    /// Tickets for the groups of a dispatch: the first of them.
    pub(crate) fn hand_out(&mut self, groups: u32) -> u32 {
        let first = tickets(groups);
        self.sum = (0..groups).map(|group| hash(first.wrapping_add(group))).fold(self.sum, u32::wrapping_add);
        first
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
        let (a, b) = (receipts.hand_out(1 << 16), receipts.hand_out(1 << 16));
        let sum = |first: u32, count: u32| (0..count).map(|k| hash(first.wrapping_add(k))).fold(0, u32::wrapping_add);
        let [a, b] = [a, b].map(|first| (first, sum(first, 1 << 16)));
        assert!(receipts.is_sum(a.1.wrapping_add(b.1)));
        // Left out, done in part, done with the numbers of the other, by others.
        let other = sum(tickets(1 << 16), 1 << 16);
        for wrong in [0, a.1, b.1, sum(a.0, 65_535).wrapping_add(b.1), a.1.wrapping_mul(2), other.wrapping_add(b.1)] {
            assert!(!receipts.is_sum(wrong));
        }
    }
}

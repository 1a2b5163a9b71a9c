//! Three-valued answers: a claim is proved, disproved, or open, and an open one says why.
//!
//! No `bool` of this library carries an unproved claim. What ran out of depth, budget or domain is a state of its own,
//! never folded into "hit" or "miss".

/// The answer to a question about the real surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Proved false.
    No,
    /// Neither proved nor disproved.
    Unknown(Reason),
    /// Proved true.
    Yes,
}

/// Why a question stayed open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Reason {
    /// The search reached its smallest interval and could still not exclude a zero: all that the paper's method asks for
    /// before it reports an intersection.
    Resolution,
    /// A zero without a proved change of sign: the surface touches, is singular there, or is not a surface at all.
    Touching,
    /// The formula may be undefined or discontinuous there, so a change of sign proves nothing.
    Domain,
    /// The permitted number of subdivisions was spent.
    Budget,
}

impl Verdict {
    /// Proved true.
    #[must_use]
    pub const fn certainly(self) -> bool {
        matches!(self, Self::Yes)
    }

    /// Not proved false.
    #[must_use]
    pub const fn possibly(self) -> bool {
        !matches!(self, Self::No)
    }
}

impl std::ops::Not for Verdict {
    type Output = Self;

    fn not(self) -> Self {
        match self {
            Self::No => Self::Yes,
            Self::Yes => Self::No,
            open => open,
        }
    }
}

impl Reason {
    /// Every reason, in the order of declaration.
    pub const ALL: [Self; 4] = [Self::Resolution, Self::Touching, Self::Domain, Self::Budget];

    /// The word used in tables and files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Resolution => "resolution",
            Self::Touching => "touching",
            Self::Domain => "domain",
            Self::Budget => "budget",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_open_question_is_neither_certain_nor_excluded() {
        for reason in Reason::ALL {
            let open = Verdict::Unknown(reason);
            assert!(!open.certainly() && open.possibly() && !open == open);
        }
        assert!(Verdict::Yes.certainly() && !Verdict::No.possibly() && !Verdict::Yes == Verdict::No);
    }
}

//! A finished frame looked at again, ray by ray, in high precision.
//!
//! What the certified search claims is claimed of *all* rays; the audit asks random ones. It shares with the search nothing
//! but the reading of the formula: values are computed from the formula as it was written, on numbers of 192 bits
//! (double precision only scouts where the sign is beyond doubt), cameras and lights from their stored numbers. It can
//! never prove a frame right; every violation that it reports is one.
mod claims;
mod precise;
mod ray;

pub use claims::{Audit, AuditSpec, Kind, Report, Tally};

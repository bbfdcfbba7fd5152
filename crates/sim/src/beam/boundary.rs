//! What holds a beam at its ends.

/// How a beam is held at its root and at its tip, for the eigenfunctions that are taken as its modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Boundary {
    /// Clamped at the root, free at the tip.
    ClampedFree,
    /// Clamped at both ends.
    ClampedClamped,
    /// Clamped at the root, its tip held in place but free to turn; bending only.
    ClampedPinned,
    /// Both ends held in place but free to turn; bending only.
    PinnedPinned,
    /// Clamped at the root, a rigid body at the tip.
    ClampedMass(TipBody),
}

/// A rigid body at the tip of a beam, as the conditions there see it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TipBody {
    /// Mass [kg].
    pub mass: f64,
    /// Inertia about the tip [kg m²]: about the axis that the tip turns about in bending, about the beam's own in torsion.
    pub inertia: f64,
    /// Mass times the distance of its centre beyond the tip [kg m]; bending only.
    pub first_moment: f64,
}

impl Boundary {
    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClampedFree => "clamped_free",
            Self::ClampedClamped => "clamped_clamped",
            Self::ClampedPinned => "clamped_pinned",
            Self::PinnedPinned => "pinned_pinned",
            Self::ClampedMass(_) => "clamped_mass",
        }
    }

    /// The body at the tip, without mass where there is none.
    pub fn tip(self) -> TipBody {
        match self {
            Self::ClampedMass(tip) => tip,
            _ => TipBody::default(),
        }
    }
}

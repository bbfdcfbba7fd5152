//! Everything that can be wrong with a description is found here, so that the algorithms need no checks.

use super::{BodySpec, Defect, DriveSpec, Friction, JointKind, ModelError, RobotSpec, SpringSpec, TransmissionSpec};
use crate::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};

/// How far a unit vector or a rotation matrix may be from one.
const UNIT_TOLERANCE: f64 = 1e-6;
/// Negative principal moments up to this part of the trace are rounding of the file ...
const FILE_ROUNDING: f64 = 1e-9;
/// ... and up to this part of the trace about the link frame, rounding of the shift to the centre of mass.
const SHIFT_ROUNDING: f64 = 1e-14;

impl RobotSpec<'_> {
    /// Finds the first defect of the description.
    ///
    /// # Errors
    /// [`ModelError`] names the body and the defect.
    pub fn validate(&self) -> Result<(), ModelError> {
        if self.bodies.len() >= usize::from(u16::MAX) {
            return Err(ModelError { body: 0, defect: Defect::TooFewBodies });
        }
        for (i, body) in self.bodies.iter().enumerate() {
            self.check_body(i, body).map_err(|defect| ModelError { body: i, defect })?;
        }
        for i in 0..self.bodies.len() {
            self.check_rotors_fit(i).map_err(|defect| ModelError { body: i, defect })?;
            self.check_something_to_move(i).map_err(|defect| ModelError { body: i, defect })?;
        }
        let g = self.gravity;
        check_finite("gravity", &g.to_array()).map_err(|defect| ModelError { body: 0, defect })
    }

    fn check_body(&self, i: usize, body: &BodySpec) -> Result<(), Defect> {
        if body.parent.is_some_and(|p| p >= i) {
            return Err(Defect::ParentNotBefore);
        }
        check_pose("the joint's placement", &body.placement)?;
        check_inertia(&body.inertia)?;
        check_friction(&body.friction)?;
        if body.joint == JointKind::Floating {
            let lone = i == 0 && body.parent.is_none() && body.drive.is_none() && body.friction == Friction::none();
            return if lone && body.placement == Transform::identity() {
                Ok(())
            } else {
                Err(Defect::FloatingNotAtRoot)
            };
        }
        if body.parent.is_none() && i > 0 && self.bodies[0].joint == JointKind::Floating {
            return Err(Defect::BesideFloating);
        }
        check_unit("the joint axis", body.axis)?;
        match &body.drive {
            Some(drive) => self.check_drive(body, drive),
            None => Ok(()),
        }
    }

    fn check_drive(&self, body: &BodySpec, drive: &DriveSpec) -> Result<(), Defect> {
        check_finite("the gear ratio", &[drive.gear_ratio])?;
        if drive.gear_ratio == 0.0 {
            return Err(Defect::ZeroGearRatio);
        }
        check_friction(&drive.friction)?;

        let rotor = &drive.rotor;
        check_positive("the rotor's inertia", rotor.inertia)?;
        check_pose("the rotor's mount", &rotor.mount.placement)?;
        check_unit("the rotor's axis", rotor.mount.axis)?;
        if let Some(b) = rotor.body {
            check_not_negative("the rotor's mass", b.mass)?;
            check_not_negative("the rotor's transverse inertia", b.transverse_inertia)?;
            if 2.0 * b.transverse_inertia < rotor.inertia * (1.0 - UNIT_TOLERANCE) {
                return Err(Defect::RotorTooFlat { transverse: b.transverse_inertia, spin: rotor.inertia });
            }
        }
        if let Some(mount) = rotor.mount.body {
            let mut ancestor = body.parent;
            while ancestor.is_some_and(|a| a != mount) {
                ancestor = ancestor.and_then(|a| self.bodies.get(a)).and_then(|b| b.parent);
            }
            if ancestor.is_none() {
                return Err(Defect::MountNotAncestor);
            }
        }

        let TransmissionSpec::Elastic { spring, damping, error } = &drive.transmission else { return Ok(()) };
        check_not_negative("the transmission's damping", *damping)?;
        match *spring {
            SpringSpec::Polynomial { stiffness, cubic } => {
                check_positive("the transmission's stiffness", stiffness)?;
                check_not_negative("the transmission's cubic stiffness", cubic)?;
            }
            SpringSpec::Table { first, len } => {
                let end = first.checked_add(len).ok_or(Defect::SpringTableNotIncreasing)?;
                let table = self.spring_tables.get(first..end).ok_or(Defect::SpringTableNotIncreasing)?;
                let increasing = table.windows(2).all(|w| w[0][0] < w[1][0] && w[0][1] < w[1][1]);
                if len < 2 || !increasing || !table.iter().flatten().all(|x| x.is_finite()) {
                    return Err(Defect::SpringTableNotIncreasing);
                }
            }
        }
        check_finite("the transmission error", &[error.amplitude, error.cycles_per_rotor_turn, error.phase])?;
        let slope = (error.amplitude * error.cycles_per_rotor_turn * drive.gear_ratio).abs();
        if slope >= 1.0 { Err(Defect::TransmissionErrorTooSteep(slope)) } else { Ok(()) }
    }

    /// Where the link is said to contain its rotors, `I − Σ J n nᵀ` must stay an inertia.
    fn check_rotors_fit(&self, i: usize) -> Result<(), Defect> {
        let mut rest = about_com(&self.bodies[i].inertia);
        let mut contained = false;
        for drive in self.carried_rotors(i).filter(|d| d.rotor.body.is_none()) {
            let mount = &drive.rotor.mount;
            let n = mount.placement.rotation() * mount.axis;
            rest = rest - SymMat3::outer(n).scale(drive.rotor.inertia);
            contained = true;
        }
        let rounding = FILE_ROUNDING * trace(&about_com(&self.bodies[i].inertia));
        if contained && !is_positive_semidefinite(&rest, rounding) { Err(Defect::RotorLargerThanLink) } else { Ok(()) }
    }

    /// Every joint must move some mass; the last joint of a branch, some inertia about its own axis.
    fn check_something_to_move(&self, i: usize) -> Result<(), Defect> {
        let body = &self.bodies[i];
        if is_rigidly_geared(body) {
            return Ok(());
        }
        let rotors = || self.carried_rotors(i).filter_map(|d| d.rotor.body);
        let mass = body.inertia.mass + rotors().map(|r| r.mass).sum::<f64>();
        let turns = |m: &SymMat3<f64>| body.axis.dot(*m * body.axis) > 0.0;
        let last = !self.bodies.iter().any(|b| b.parent == Some(i));
        let moves = match body.joint {
            JointKind::Prismatic => mass > 0.0 || self.beyond(i, |b| b.inertia.mass > 0.0),
            JointKind::Revolute if last => turns(&body.inertia.rotational),
            JointKind::Revolute => has_moment(body) || rotors().next().is_some() || self.beyond(i, has_moment),
            JointKind::Floating if last => mass > 0.0 && is_positive_definite(&about_com(&body.inertia)),
            JointKind::Floating => {
                (mass > 0.0 || self.beyond(i, |b| b.inertia.mass > 0.0))
                    && (has_moment(body) || self.beyond(i, has_moment))
            }
        };
        if moves { Ok(()) } else { Err(Defect::NothingToMove) }
    }

    /// Whether some body beyond joint `i` has what it takes. A child's joint of the same kind is checked by itself, so the
    /// whole branch is searched just where the kinds alternate.
    fn beyond(&self, i: usize, has: impl Fn(&BodySpec) -> bool) -> bool {
        let kind = self.bodies[i].joint;
        let mut children = self.bodies.iter().filter(|b| b.parent == Some(i));
        children.any(|b| has(b) || (b.joint == kind && !is_rigidly_geared(b)))
            || (i + 1..self.bodies.len()).any(|k| has(&self.bodies[k]) && self.is_at_or_beyond(k, i))
    }

    /// The drives whose rotors body `i` carries.
    fn carried_rotors(&self, i: usize) -> impl Iterator<Item = &DriveSpec> {
        self.bodies.iter().filter_map(|b| b.drive.as_ref()).filter(move |d| d.rotor.mount.body == Some(i))
    }

    /// Whether body `k` is body `root` or moved by its joint.
    fn is_at_or_beyond(&self, mut k: usize, root: usize) -> bool {
        while k > root {
            match self.bodies[k].parent {
                Some(parent) => k = parent,
                None => return false,
            }
        }
        k == root
    }
}

fn is_rigidly_geared(body: &BodySpec) -> bool {
    body.drive.is_some_and(|d| matches!(d.transmission, TransmissionSpec::Rigid))
}

fn has_moment(body: &BodySpec) -> bool {
    trace(&body.inertia.rotational) > 0.0
}

fn check_finite(what: &'static str, numbers: &[f64]) -> Result<(), Defect> {
    if numbers.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Defect::NotFinite(what)) }
}

fn check_positive(what: &'static str, x: f64) -> Result<(), Defect> {
    check_finite(what, &[x])?;
    if x > 0.0 { Ok(()) } else { Err(Defect::NotPositive(what, x)) }
}

fn check_not_negative(what: &'static str, x: f64) -> Result<(), Defect> {
    check_finite(what, &[x])?;
    if x >= 0.0 { Ok(()) } else { Err(Defect::Negative(what, x)) }
}

fn check_unit(what: &'static str, a: Vec3<f64>) -> Result<(), Defect> {
    check_finite(what, &a.to_array())?;
    let norm = crate::Scalar::sqrt(a.dot(a));
    if (norm - 1.0).abs() <= UNIT_TOLERANCE { Ok(()) } else { Err(Defect::NotUnit(what, norm)) }
}

fn check_pose(what: &'static str, pose: &Transform<f64>) -> Result<(), Defect> {
    check_finite(what, &pose.pos.to_array())?;
    for row in pose.rot.rows {
        check_finite(what, &row.to_array())?;
    }
    let product = pose.rot * pose.rot.transpose() - Mat3::identity();
    let orthonormal = product.rows.iter().all(|r| r.to_array().iter().all(|x| x.abs() <= UNIT_TOLERANCE));
    let [x, y, z] = pose.rot.rows;
    if orthonormal && x.cross(y).dot(z) > 0.0 { Ok(()) } else { Err(Defect::NotARotation(what)) }
}

fn check_friction(f: &Friction<f64>) -> Result<(), Defect> {
    check_not_negative("viscous friction", f.viscous)?;
    check_not_negative("Coulomb friction", f.coulomb)?;
    check_not_negative("Stribeck friction", f.stribeck)?;
    check_positive("the smoothing velocity of friction", f.smoothing_velocity)?;
    check_positive("the Stribeck velocity", f.stribeck_velocity)
}

fn check_inertia(i: &SpatialInertia<f64>) -> Result<(), Defect> {
    check_not_negative("the link's mass", i.mass)?;
    check_finite("the link's centre of mass", &i.first_moment.to_array())?;
    let r = i.rotational;
    check_finite("the link's inertia", &[r.xx, r.yy, r.zz, r.xy, r.xz, r.yz])?;
    if i.mass == 0.0 && i.first_moment != Vec3::new(0.0, 0.0, 0.0) {
        return Err(Defect::MasslessInertia);
    }
    let about_com = about_com(i);
    let rounding = FILE_ROUNDING * trace(&about_com).abs() + SHIFT_ROUNDING * trace(&r).abs();
    if is_positive_semidefinite(&about_com, rounding) { Ok(()) } else { Err(Defect::InertiaNotPositive) }
}

/// Rotational inertia about the centre of mass: `I + c× m c×`.
fn about_com(i: &SpatialInertia<f64>) -> SymMat3<f64> {
    if i.mass == 0.0 {
        return i.rotational;
    }
    let com = i.first_moment.scale(1.0 / i.mass);
    i.rotational - SpatialInertia::from_com(i.mass, com, SymMat3::zero()).rotational
}

/// Sylvester's criterion on all principal minors of `a + rounding 1`.
fn is_positive_semidefinite(a: &SymMat3<f64>, rounding: f64) -> bool {
    let shifted = *a + SymMat3::diagonal(rounding, rounding, rounding);
    principal_minors(&shifted).iter().all(|m| *m >= 0.0)
}

fn is_positive_definite(a: &SymMat3<f64>) -> bool {
    principal_minors(a).iter().all(|m| *m > 0.0)
}

fn principal_minors(a: &SymMat3<f64>) -> [f64; 7] {
    let det =
        a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.xz) + a.xz * (a.xy * a.yz - a.yy * a.xz);
    [a.xx, a.yy, a.zz, a.xx * a.yy - a.xy * a.xy, a.xx * a.zz - a.xz * a.xz, a.yy * a.zz - a.yz * a.yz, det]
}

fn trace(a: &SymMat3<f64>) -> f64 {
    a.xx + a.yy + a.zz
}

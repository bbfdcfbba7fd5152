//! Unit forces of a constraint on their way to the base, after the articulated-body algorithm's second sweep (Wensing, Featherstone & Orin
//! 2012).
//!
//! A joint takes `S·f` of a force `f` beyond it, and accelerates by `S·f/d`; the rest, `f − W S·f/d` with `W = U` seen from the parent,
//! goes on. For two constraints, the entry of `J M⁻¹ Jᵀ` is the sum of the products of what the joints on both ways take, over `d`, and what
//! the base gives way. On the same way, a force does work on all accelerations that there are without constraints.
//!
//! Everything is in base axes, where a force is the same at every body.

use super::anchor::Held;
use super::frames::{SupportScratch, bodies, joint_of};
use super::spec::{Constraint, Hold};
use crate::Scalar;
use crate::dispatch::Over;
use crate::dynamics::AbaScratch;
use crate::dynamics::aba_base::Base;
use crate::dynamics::tree::Tree;
use crate::spatial::{Force, Mat3, Motion, Vec3};

/// What is kept for one constraint at one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct PropagatedScratch<T> {
    /// `S·f` of the six directions.
    pub(super) taken: [T; 6],
    /// Whether the body is on the constraint's way to the base.
    pub(super) on_way: bool,
}

impl<T: Scalar> PropagatedScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self { taken: [T::zero(); 6], on_way: false }
    }
}

impl<T: Scalar> Default for PropagatedScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// What is kept for one constraint during a call.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintScratch<T> {
    /// The constraint at the present state.
    pub(super) held: Held<T>,
    /// Force of the six directions that arrives at the base.
    pub(super) at_base: [Force<T>; 6],
    /// How the base would accelerate under it.
    pub(super) gives_way: [Motion<T>; 6],
    /// `Φ̈` of the six directions without the constraints' forces.
    pub(super) free: [T; 6],
}

impl<T: Scalar> ConstraintScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self { held: Held::free(), at_base: [Force::zero(); 6], gives_way: [Motion::zero(); 6], free: [T::zero(); 6] }
    }
}

impl<T: Scalar> Default for ConstraintScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Six forces, coordinate by coordinate, so that all six are computed side by side.
type Forces<F> = [[F; 6]; 6];

#[inline(always)]
fn rows<F: Scalar>(columns: &[Force<F>; 6]) -> Forces<F> {
    let mut rows = [[F::zero(); 6]; 6];
    for (c, column) in columns.iter().enumerate() {
        for (row, entry) in rows.iter_mut().zip(column.to_array()) {
            row[c] = entry;
        }
    }
    rows
}

#[inline(always)]
fn columns<F: Scalar>(rows: &Forces<F>) -> [Force<F>; 6] {
    let mut columns = [Force::zero(); 6];
    for (c, column) in columns.iter_mut().enumerate() {
        *column = Force::from([rows[0][c], rows[1][c], rows[2][c], rows[3][c], rows[4][c], rows[5][c]]);
    }
    columns
}

/// `m·f` of six forces.
#[inline(always)]
fn work<F: Scalar>(m: Motion<F>, forces: &Forces<F>) -> [F; 6] {
    let m = m.to_array();
    let mut sums = [F::zero(); 6];
    for (m, row) in m.into_iter().zip(forces) {
        for c in 0..6 {
            sums[c] = m.mul_add(row[c], sums[c]);
        }
    }
    sums
}

/// Sends the forces of one constraint to the base.
#[inline(always)]
pub(super) fn propagate<T: Scalar, F: Over<T>>(
    constraint: &Constraint<T>,
    held: &Held<F>,
    tree: &Tree<'_, T::Param>,
    base: &Base<F>,
    (lift, free_base): (Vec3<F>, Motion<F>),
    (aba, supports): (&[AbaScratch<T>], &[SupportScratch<T>]),
    (way, kept): (&mut [PropagatedScratch<T>], &mut ConstraintScratch<T>),
) {
    way.iter_mut().for_each(|w| w.on_way = false);
    let on_frame = rows(&held.wrenches);
    let [mut a, mut b] = bodies(constraint).map(|body| joint_of(tree, body));
    let in_world = bodies(constraint)[1].is_none();
    // The anchor's body feels the opposite; the fixed world does not matter.
    let mut on_anchor = if in_world { [[F::zero(); 6]; 6] } else { on_frame.map(|row| row.map(|x| -x)) };
    let mut on_frame = on_frame;
    let coupled = match &constraint.hold {
        Hold::Joints { ratio, .. } => Some(([a, b], F::load(*ratio))),
        Hold::Frame { .. } => None,
    };

    // Accelerations without the constraints, on the way gathered; the world's are without gravity's lift.
    let mut free = held.bias;
    if in_world {
        let lifted = work(Motion { ang: Vec3::zero(), lin: lift }, &on_frame);
        for c in 0..6 {
            free[c] -= lifted[c];
        }
    }
    while a.is_some() || b.is_some() {
        // From whichever body is farther out; where the ways meet, both go on as one.
        let (at, from_frame) = if a >= b { (a, true) } else { (b, false) };
        if a == b {
            for (row, other) in on_frame.iter_mut().zip(&mut on_anchor) {
                for c in 0..6 {
                    row[c] += other[c];
                    other[c] = F::zero();
                }
            }
        }
        let Some(i) = at else { break };
        let (Some(body), Some(s), Some(x), Some(w)) = (tree.joints.get(i), aba.get(i), supports.get(i), way.get_mut(i))
        else {
            break;
        };
        let forces = if from_frame { &mut on_frame } else { &mut on_anchor };

        // S·f, and for coupled joints the unit torque at the joint itself
        let mut taken = work(x.axis.map(F::load), forces);
        if let Some((coupled, ratio)) = coupled {
            if coupled[0] == at {
                taken[0] += F::one();
            }
            if coupled[1] == at {
                taken[0] -= ratio;
            }
        }
        let (pose, d_inv) = (x.pose.map(F::load), F::load(s.d_inv));
        let (c, u) = (pose.inv_motion(s.c.map(F::load)), F::load(s.u));
        let along = work(c, forces);
        // W = Xᵀ U + [N J n; 0]: a rigidly geared rotor leans on the parent, too.
        let mut lean = pose.inv_force(s.u_cap.map(F::load));
        if body.rigid_rotor().is_some() && body.parent.is_some() {
            let parent = match tree.joint(body.parent).and_then(|p| supports.get(p)) {
                Some(p) => p.pose.rot.map(F::load),
                None => Mat3::identity(),
            };
            lean.ang += parent.transpose_mul(body.rigid_coupling::<F>().ang);
        }
        let lean = lean.to_array();
        let gone = taken.map(|taken| taken * d_inv);
        for k in 0..6 {
            free[k] = u.mul_add(gone[k], free[k] + along[k]);
        }
        for (row, lean) in forces.iter_mut().zip(lean) {
            for c in 0..6 {
                row[c] = (-lean).mul_add(gone[c], row[c]);
            }
        }
        w.taken = taken.map(F::store);
        w.on_way = true;

        let next = tree.joint(body.parent);
        if a == b {
            (a, b) = (next, next);
        } else if from_frame {
            a = next;
        } else {
            b = next;
        }
    }
    for (row, other) in on_frame.iter_mut().zip(&on_anchor) {
        for c in 0..6 {
            row[c] += other[c];
        }
    }
    let moved = work(free_base, &on_frame);
    for c in 0..6 {
        free[c] += moved[c];
    }
    let at_base = columns(&on_frame);
    let mut gives_way = [Motion::zero(); 6];
    if tree.root.is_some() {
        for (way, force) in gives_way.iter_mut().zip(at_base) {
            *way = base.ia.solve(force);
        }
    }
    kept.held = held.map(F::store);
    kept.free = free.map(F::store);
    kept.at_base = at_base.map(|f| f.map(F::store));
    kept.gives_way = gives_way.map(|m| m.map(F::store));
}

/// The block of `J M⁻¹ Jᵀ` of two constraints, all directions.
#[inline(always)]
pub(super) fn block<T: Scalar, F: Over<T>>(
    aba: &[AbaScratch<T>],
    (way_a, a): (&[PropagatedScratch<T>], &ConstraintScratch<T>),
    (way_b, b): (&[PropagatedScratch<T>], &ConstraintScratch<T>),
) -> [[F; 6]; 6] {
    let mut block = [[F::zero(); 6]; 6];
    for ((s, on_a), on_b) in aba.iter().zip(way_a).zip(way_b) {
        if !on_a.on_way || !on_b.on_way {
            continue;
        }
        let d_inv = F::load(s.d_inv);
        let right = on_b.taken.map(F::load);
        for (row, left) in block.iter_mut().zip(on_a.taken) {
            let left = F::load(left) * d_inv;
            for c in 0..6 {
                row[c] = left.mul_add(right[c], row[c]);
            }
        }
    }
    let way = b.gives_way.map(|m| m.map(F::load));
    for (row, force) in block.iter_mut().zip(a.at_base) {
        let force = force.map(F::load);
        for c in 0..6 {
            row[c] += way[c].dot(force);
        }
    }
    block
}

/// Writes the held directions of a block into a matrix of so many rows, from a row and a column on.
#[inline(always)]
pub(super) fn write<T: Scalar, F: Over<T>>(
    block: &[[F; 6]; 6],
    (a, b): (&Constraint<T>, &Constraint<T>),
    (row, column): (usize, usize),
    size: usize,
    matrix: &mut [T],
) {
    let (all, counts) = (b.rows() == 6, [0, 1, 2, 3, 4, 5].map(|j| b.holds(j)));
    let mut row = row;
    for (i, entries) in block.iter().enumerate() {
        if !a.holds(i) {
            continue;
        }
        let places = matrix.get_mut(row * size + column..).unwrap_or_default();
        row += 1;
        if let (true, Some(places)) = (all, places.first_chunk_mut::<6>()) {
            for c in 0..6 {
                places[c] = entries[c].store();
            }
            continue;
        }
        let held = entries.iter().zip(&counts).filter(|(_, counts)| **counts);
        for (place, (entry, _)) in places.iter_mut().zip(held) {
            *place = entry.store();
        }
    }
}

/// Below the diagonal, what stands above it.
#[inline(always)]
pub(super) fn mirror<T: Scalar>(size: usize, matrix: &mut [T]) {
    for row in 1..size {
        let (above, below) = matrix.split_at_mut_checked(row * size).unwrap_or_default();
        for (column, place) in below.iter_mut().enumerate().take(row) {
            if let Some(entry) = above.get(column * size + row) {
                *place = *entry;
            }
        }
    }
}

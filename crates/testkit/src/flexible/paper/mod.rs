//! Cetinkunt & Book, *Symbolic modeling and dynamic simulation of robotic manipulators with compliant links and joints*, Int. J.
//! Robotics and Computer-Integrated Manufacturing, 1988: their model of a serial arm, in 4×4 matrices, written out.
//!
//! A chain of joints (odd elements) and flexible links (even elements), `W_k = A_1 A_2 … A_k`. The end of a link moves and turns by what
//! is linear in the modal coordinates, `A_2i = A'_2i (1 + Σ q_2i,j Δ_j)` (eq. 6–9): its upper left block is no rotation where the link is
//! bent. [`CetinkuntBook`] has the inertia matrix (eq. 32), centrifugal and Coriolis terms (33), gravity (34), stiffness (35) and
//! elastic joints (46) as the paper explains them term by term; [`AsPoints`] is the same arm as points for Lagrange's equations by automatic
//! differentiation, which are what found the slips of the print:
//!
//! * (20.c) has index `j` in both factors. With `k` in the second, `C_2i,j,k = ∫ φ_j φ_kᵀ dm` as here, (19), (32.b) and (33) need
//!   `C_2i,k,j` where they print `C_2i,j,k` beside `q_2i,k q̇_2i,j`, `C_s,k,t` for `C_s,t,k`, and `C_p,k,r` for `C_p,r,k`: in
//!   `∫ h ḣᵀ` the first factor has the deflection. With `k` in the first, they are right as printed.
//! * (22), (23), (34): with `g = (0, 0, −9.81)` of (24) gravity's potential is `−gᵀ …`.
//! * (27), (29.b), (29.c): bending along `z` takes the section's moment about `y`, and the other way round.
//! * (31): the first sum ends at `2N`, not `2n`.
//! * (32.a): the sum begins at the larger of `(p+1)/2` and `(s+1)/2`; printed `p + ½`, `s + ½`.
//! * (32.b) is the part of a joint's row and a mode's column; the transposed part is missing, without which the matrix is not symmetric.
//! * (32.c) lacks its trace.
//! * (33): the sums over links begin at `(p+1)/2`, there is no `s` yet; the third term has `W_p−1` for `W_2i−1`, and the last
//!   one `q̇_p,k` for `q_p,k`.
//! * (41): `δ` is Dirac's; with Kronecker's the integrals of (40) vanish.
//! * (42): `−q̇ᵀ` has no reason for its sign.
//! * (46.a): by (45) the joints feel `K_t (q_3 − q_1)`, not `K_t (q_1 − q_3)`.

mod chain;
mod equations;
mod points;

pub use chain::CetinkuntBook;
pub use points::AsPoints;

//! Pass 2, tips to base: articulated inertias of links whose modes are free.

use super::link::Deflected;
use super::modes::eliminate;
use super::outward::Known;
use super::scratch::FlexibleScratch;
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Force, Vec3};

impl<T: Scalar> Known<'_, T> {
    /// `Iᴬ` and `pᴬ` of body `i` with what hangs on it: on its stations, once its modes are eliminated.
    pub(super) fn articulate(&self, i: usize, scratch: &mut FlexibleScratch<T>) -> (ArticulatedInertia<T>, Force<T>) {
        let s = &scratch.bodies[i];
        let (mut ia, mut p) = (s.ia.plus_rigid(s.inertia), s.p);
        let Some(link) = self.model.link_of(i) else { return (ia, p) };
        let own = Deflected::<T::Param, T>::of(self.model, link, self.eta, self.etad);
        let (n, pairs) = (link.n(), link.pair_range());
        let (modes, matrix) = (&mut scratch.modes[link.mode_range()], &mut scratch.matrix[pairs]);
        for j in 0..n {
            for k in 0..=j {
                matrix[j * n + k] = own.modal_mass(j, k);
            }
        }
        for (k, station) in scratch.stations[link.station_range()].iter().enumerate() {
            // With a_s = X_s a + Σ Φ_j η̈_j + c:   Iᴬ += X_sᵀ Iᴬ_s X_s,   U_j += X_sᵀ Iᴬ_s Φ_j,   M_jk += Φ_jᵀ Iᴬ_s Φ_k
            let columns = &scratch.shapes[link.shape_range(k)];
            let f = station.ia.force(station.c) + station.p;
            for (j, column) in columns.iter().enumerate() {
                let moved = station.ia.force(*column);
                modes[j].u_cap += station.x.inv_force(moved);
                modes[j].p += column.dot(f);
                for (k, other) in columns.iter().enumerate().take(j + 1) {
                    matrix[j * n + k] += other.dot(moved);
                }
            }
            ia += station.ia.seen_from_parent(station.x);
            p += station.x.inv_force(f);
        }
        eliminate(modes, matrix, &mut ia, &mut p);
        (ia, p)
    }

    /// Hangs an inertia and a force on the frame that the joint of body `i` sits on; the world bears whatever comes.
    pub(super) fn hang(&self, i: usize, scratch: &mut FlexibleScratch<T>, ia: ArticulatedInertia<T>, p: Force<T>) {
        match (self.model.seats[i].parent, self.model.rigid.bodies[i].parent()) {
            (Some(station), _) => {
                let station = &mut scratch.stations[usize::from(station)];
                station.ia += ia;
                station.p += p;
            }
            (None, Some(parent)) => {
                let parent = &mut scratch.bodies[parent];
                parent.ia += ia;
                parent.p += p;
            }
            (None, None) => {}
        }
    }

    /// Puts the couple that the rotor of body `i`'s joint needs on the frame that carries it.
    pub(super) fn burden_carrier(&self, i: usize, scratch: &mut FlexibleScratch<T>, couple: Vec3<T>) {
        match (self.model.seats[i].rotor, self.model.rigid.bodies[i].carrier()) {
            (Some(station), _) => scratch.stations[usize::from(station)].p.ang += couple,
            (None, Some(body)) => scratch.bodies[usize::from(body)].p.ang += couple,
            (None, None) => {}
        }
    }
}

//! Nothing in the core allocates: a counting allocator watches every algorithm.

mod common;
use common::{Lowered, drive, elastic, link};
use gyroflex::dynamics::*;
use gyroflex::integrate::*;
use gyroflex::model::*;
use gyroflex::spatial::{Motion, Transform};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    // Per thread, so that the test harness's own threads do not count.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is forwarded unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|n| n.set(n.get() + 1));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(work: impl FnOnce()) -> usize {
    let before = ALLOCATIONS.with(Cell::get);
    work();
    ALLOCATIONS.with(Cell::get) - before
}

#[test]
fn the_counter_counts() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1u8; 100]))), 1);
}

#[test]
fn no_algorithm_allocates() {
    let root = BodySpec { joint: JointKind::Floating, ..link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]) };
    let mut elbow = link(Some(0), [0.0, 1.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.0, 0.0]);
    elbow.drive = Some(drive(Some(0), [0.0, 1.0, 0.0], 80.0, elastic(800.0, 1.0)));
    elbow.friction = Friction::coulomb(0.1, 0.2, 0.01).with_stribeck(0.1, 0.2);
    let mut wrist = link(Some(1), [1.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.1, 0.0, 0.0]);
    // Away from the joint's parent: the joint-space route.
    wrist.drive = Some(drive(Some(0), [0.0, 0.0, 1.0], 50.0, TransmissionSpec::Rigid));
    let robot = Lowered::new(&[root, elbow, wrist], [0.0, 0.0, -9.81], Fidelity::Complete);
    let model = robot.model();
    assert!(model.has_remote_rigid_rotor());

    let mut q = vec![0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.2, -0.4];
    let (mut qd, mut theta, mut thetad) = (vec![0.1; 8], vec![0.2; 8], vec![0.1; 8]);
    let (tau, mut qdd, mut thetadd, mut tau_j) = (vec![0.3; 8], vec![0.0; 8], vec![0.0; 8], vec![0.0; 8]);
    let mut aba_scratch = vec![AbaScratch::new(); 3];
    let mut rnea_scratch = vec![RneaScratch::new(); 3];
    let mut crba_scratch = vec![CrbaScratch::new(); 3];
    let mut moving = vec![(Transform::identity(), Motion::zero()); 3];
    let mut joint_space = vec![JointSpaceScratch::new(); joint_space_len(&model)];
    let (mut m, mut matrix) = (vec![0.0; 64], vec![0.0; matrix_len(&model)]);
    let mut work = vec![0.0; rk4_len(&model).max(euler_len(&model))];

    let count = allocations(|| {
        let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
        let ext = External::none();
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        aba(&model, state, &tau, ext, &mut aba_scratch, out).unwrap();
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        let scratch = ForwardScratch { bodies: &mut aba_scratch, joint_space: &mut joint_space, matrix: &mut matrix };
        forward_dynamics(&model, state, &tau, ext, scratch, out).unwrap();
        let accel = Acceleration { qdd: &tau, thetadd: &tau };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut thetadd };
        rnea(&model, state, accel, ext, &mut rnea_scratch, out).unwrap();
        crba(&model, &q, &mut crba_scratch, &mut m).unwrap();
        coupling(&model, &q, &mut crba_scratch, &mut m).unwrap();
        energy(&model, state, &mut moving).unwrap();
        power(&model, state, &tau, ext, &mut moving).unwrap();
        for _ in 0..3 {
            let state = StateMut { q: &mut q, qd: &mut qd, theta: &mut theta, thetad: &mut thetad };
            let scratch =
                ForwardScratch { bodies: &mut aba_scratch, joint_space: &mut joint_space, matrix: &mut matrix };
            let n = rk4_len(&model);
            rk4(&model, state, &tau, ext, 1e-4, scratch, &mut work[..n]).unwrap();
            let state = StateMut { q: &mut q, qd: &mut qd, theta: &mut theta, thetad: &mut thetad };
            let scratch =
                ForwardScratch { bodies: &mut aba_scratch, joint_space: &mut joint_space, matrix: &mut matrix };
            let n = euler_len(&model);
            semi_implicit_euler(&model, state, &tau, ext, 1e-4, scratch, &mut work[..n]).unwrap();
        }
    });
    assert_eq!(count, 0);
    assert!(q.iter().chain(&qd).all(|x: &f64| x.is_finite()));
}

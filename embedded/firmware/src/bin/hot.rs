//! Nothing but what a 1 kHz loop calls: its size is what a controller pays, and its symbols say whether it can panic.
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m_rt::entry;
use gyroflex::dynamics::placements;
use gyroflex::integrate::integrate;
use gyroflex::spatial::Transform;
use gyroflex_firmware::arm::{N, complete};
use gyroflex_firmware::controller::{Controller, Measured, PERIOD};
use gyroflex_firmware::elastic::Elastic;
use gyroflex_firmware::held::Held;
use gyroflex_firmware::random::{Dice, Point};
use gyroflex_firmware::reference::Reference;

#[entry]
fn main() -> ! {
    // Behind a black box, the model may be any: the compiler keeps the code for every joint, drive and friction.
    let model = black_box(&complete::MODEL);
    let reference = Reference::new([0.0; N], [1.0; N], 1.0);
    let mut controller = Controller::new(model, [0.0; N]);
    let mut poses = [Transform::identity(); N];
    let mut next = [0.0; N];
    let mut way = 0.0;
    let (mut elastic, mut held, mut dice) = (Elastic::new(), Held::new(), Dice::new(1));
    loop {
        let measured = black_box(Measured::default());
        // A wrong length is an error, never a panic.
        let tau = controller.step(&reference.at(way, false), &measured);
        let placed = placements(model, &measured.q, &mut poses);
        let moved = integrate(model, &measured.q, &measured.qd, &mut next);
        let inverted = elastic.invert(model, &Point::random(&mut dice));
        let point = Point::random(&mut dice);
        let (held_by, caught, driven) =
            (held.accelerate(model, &point), held.catch(model, &point), held.drive(model, &point));
        black_box((&held_by, &caught, &driven, &held.tau, &held.wrench));
        black_box((&inverted, &elastic.tau, &tau, &placed, &moved, &poses, &next, &controller.observer.contact));
        way += PERIOD;
    }
}

/// Only linked if something can panic.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {
        cortex_m::asm::bkpt();
    }
}

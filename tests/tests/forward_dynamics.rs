use gyroflex::model::Fidelity;
use gyroflex_testkit::dense::Oracle;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::relative_error;
use gyroflex_tests::{Core, for_robots};

#[test]
fn probe() {
    let d = Options::default();
    for (name, o) in [
        ("all", d.clone()),
        ("no floating", Options { floating: 0.0, ..d.clone() }),
        ("no prismatic", Options { prismatic: 0.0, ..d.clone() }),
        ("no branching", Options { branching: 0.0, ..d.clone() }),
        ("no remote", Options { remote_mount: 0.0, ..d.clone() }),
        ("no contained", Options { contained: 0.0, ..d.clone() }),
        ("all elastic", Options { elastic: 1.0, ..d.clone() }),
        ("no te", Options { transmission_error: 0.0, ..d.clone() }),
        ("no fric", Options { friction: 0.0, ..d.clone() }),
        ("no table", Options { table: 0.0, ..d.clone() }),
        ("no damping", Options { damping: 0.0, ..d.clone() }),
    ] {
        for fidelity in [Fidelity::Complete, Fidelity::Rigid] {
            let mut worst: Vec<(f64, f64, u64, usize)> = Vec::new();
            for_robots(200, 1, &o, |robot| {
                let s = robot.state(0);
                let want = Oracle::new(robot.spec(), fidelity).forward(&s);
                let c = Core::<f64>::new(&robot.spec(), fidelity);
                let got = c.forward(&s);
                let got2 = c.forward_in_joint_space(&s);
                let e = relative_error(&got.qdd, &want.qdd, 0.0)
                    .max(relative_error(&got.thetadd, &want.thetadd, 0.0))
                    .max(relative_error(&got.tau_j, &want.tau_j, 0.0));
                let e32 = relative_error(&got2.qdd, &want.qdd, 0.0);
                worst.push((e, e32, robot.seed, robot.bodies.len()));
            });
            worst.sort_by(|a, b| b.0.total_cmp(&a.0));
            println!("{name} {} f64 {:?}", fidelity.name(), &worst[..3]);
            println!("{} below 1e-11", worst.iter().filter(|w| w.0 < 1e-11).count());
        }
    }
}

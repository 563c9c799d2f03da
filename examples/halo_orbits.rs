//! draft
use lagrange_core::orbits::BifurcationKind;
use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[define(r1 = sqrt((x + mu)^2 + y^2 + z^2))]
#[define(r2 = sqrt((x - 1 + mu)^2 + y^2 + z^2))]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2 + z_dot^2)/2 + (1 - mu)/r1 + mu/r2)]
struct Moon {
    mu: f64,
}

fn main() -> Result<(), Error> {
    let moon = Moon { mu: 0.012_150_585_609_624_04 };
    let now = std::time::Instant::now();
    let guess = State::new([0.8234, 0.0, 0.0], [0.0, 0.1263, 0.0]);
    let search = moon
        .periodic_orbit(&guess)
        .period_near(2.7430)
        .segments(4)
        .mirrored(&["y", "x_dot", "z_dot"])
        .tolerance(1e-11);
    let first = search.find()?;
    println!("{first}");
    println!("{:?}", now.elapsed());
    let lyapunov = search.family(&first).orbits(30).longest_step(0.05).follow()?;
    println!("{lyapunov}");
    println!("{:?}", now.elapsed());
    let back = search.family(&first).orbits(20).step(0.01).backwards().follow()?;
    println!("{back}");
    for point in lyapunov.bifurcations() {
        println!(
            "{:?} C = {:.15} {} {:e}",
            point.kind,
            -2.0 * point.value,
            point.orbit.start,
            point.orbit.error
        );
    }
    let Some(point) = lyapunov.first(BifurcationKind::BranchPoint) else { return Ok(()) };
    let near = |o: &lagrange_core::orbits::PeriodicOrbit<Moon>| {
        o.nodes
            .iter()
            .map(|s| ((s.q[0] - 1.0 + moon.mu).powi(2) + s.q[1].powi(2) + s.q[2].powi(2)).sqrt())
            .fold(1.0, f64::min)
    };
    let halo = search
        .branch(point)
        .orbits(1000)
        .step(0.01)
        .longest_step(0.01)
        .until(|o| near(o) < 0.00452)
        .follow()?;
    println!("{halo}");
    println!("{:?}", now.elapsed());
    for point in halo.bifurcations() {
        println!(
            "{:?} C = {:.15} {} {:e}",
            point.kind,
            -2.0 * point.value,
            point.orbit.start,
            point.orbit.error
        );
    }
    println!("mean iterations {}", halo.orbits().iter().map(|o| o.iterations).sum::<usize>() as f64 / 200.0);
    let worst = halo.orbits().iter().map(|o| o.gap).fold(0.0, f64::max);
    println!("largest gap {worst:e}");
    println!("{}", halo.orbits().last().unwrap());
    Ok(())
}

//! `rapier RATE ITERATIONS ENDS` moves the spheres by rapier with so many steps a second and iterations of its solver.

use std::time::Instant;

use nalgebra::Unit;
use rapier3d_f64::prelude::*;
use spheres::{COUNT, FRICTION, GRAVITY, MASS, RADIUS, RESTITUTION, Run, SECONDS, position, velocity};

fn run(rate: usize, iterations: usize) -> Run {
    let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
    let floor = ColliderBuilder::halfspace(Unit::new_unchecked(Vector::Z));
    colliders.insert(floor.friction(FRICTION).restitution(RESTITUTION));
    let insert = |i: usize| {
        let ([x, y, z], [along, across]) = (position(i), velocity(i));
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(x, y, z)).can_sleep(false);
        let body = bodies.insert(body.linvel(Vector::new(along, across, 0.0)));
        let ball = ColliderBuilder::ball(RADIUS).mass(MASS).friction(FRICTION).restitution(RESTITUTION);
        colliders.insert_with_parent(ball, body, &mut bodies);
        body
    };
    let handles: Vec<RigidBodyHandle> = (0..COUNT).map(insert).collect();
    let settings = IntegrationParameters {
        dt: 1.0 / rate as f64,
        num_solver_iterations: iterations,
        ..Default::default()
    };
    let (mut islands, mut broad, mut narrow) =
        (IslandManager::new(), DefaultBroadPhase::new(), NarrowPhase::new());
    let (mut joints, mut multibodies, mut soft, mut ccd) =
        (ImpulseJointSet::new(), MultibodyJointSet::new(), SoftBodySet::new(), CCDSolver::new());
    let (mut pipeline, mut run) = (PhysicsPipeline::new(), Run::default());
    for _ in 0..SECONDS * rate {
        let now = Instant::now();
        pipeline.step(
            Vector::new(0.0, 0.0, -GRAVITY),
            &settings,
            &mut islands,
            &mut broad,
            &mut narrow,
            &mut bodies,
            &mut colliders,
            &mut joints,
            &mut multibodies,
            &mut soft,
            &mut ccd,
            &(),
            &(),
        );
        run.spent += now.elapsed();
        handles.iter().for_each(|&handle| run.passes(bodies[handle].translation().z));
    }
    for (i, &handle) in handles.iter().enumerate() {
        let (v, w) = (bodies[handle].linvel(), bodies[handle].angvel());
        run.ends(i, [v.x, v.y], [v.x - RADIUS * w.y, v.y + RADIUS * w.x]);
    }
    run
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let mut number = || arguments.next().and_then(|number| number.parse().ok()).expect("a number");
    let (rate, iterations) = (number(), number());
    spheres::answer(&arguments.next().expect("a file"), || run(rate, iterations));
}

//! Shares partial sums of definitions: `vx[i] = sum(j in 0..i+1, …)` becomes `vx[i-1]` plus one term, however it is
//! spelled.

use super::problem::{Limit, Problem};
use crate::symbolic::{Graph, Id};

impl Problem {
    /// Rewrites the sums in L by their common partial sums, in L and in every other expression. Systems with frames are
    /// skipped: their lowered form already shares sums. So are loops over elements, whose equations have few terms.
    pub(super) fn nest_sums(&mut self, graph: &mut Graph) {
        if self.frames.len() > 1 || self.many.is_open() {
            return;
        }
        let mut roots: Vec<Id> = self.names.keys().copied().collect();
        self.visit(|id| roots.push(*id));
        let Some((nested, new)) = graph.nested(self.lagrangian, &roots) else { return };
        *graph = nested;
        self.visit(|id| *id = new[id]);
        // If several names have one value, the first name stays.
        let mut names: Vec<(Id, String)> = self.names.drain().collect();
        names.sort_unstable();
        for (id, name) in names {
            self.names.entry(new[&id]).or_insert(name);
        }
    }

    /// Visits every expression of the system.
    fn visit(&mut self, mut visit: impl FnMut(&mut Id)) {
        visit(&mut self.lagrangian);
        self.terms.iter_mut().chain(&mut self.forces).for_each(&mut visit);
        for (force, velocity) in &mut self.powers {
            visit(force);
            visit(velocity);
        }
        self.dissipation.iter_mut().for_each(|(function, _)| visit(function));
        self.constraints.iter_mut().for_each(|(_, constraint)| visit(constraint));
        for friction in &mut self.frictions {
            friction.sliding.iter_mut().chain(&mut friction.bounds).for_each(&mut visit);
        }
        self.switches.iter_mut().flatten().for_each(&mut visit);
        self.contacts.iter_mut().for_each(|contact| visit(&mut contact.restitution));
        self.limits.iter_mut().for_each(|Limit { value, arguments, .. }| {
            arguments.iter_mut().chain([value]).for_each(&mut visit);
        });
        self.observables.iter_mut().flat_map(|observed| &mut observed.values).for_each(visit);
    }
}

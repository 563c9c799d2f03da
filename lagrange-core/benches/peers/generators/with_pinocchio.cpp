// Pinocchio: accelerations.
#include "pinocchio_model.h"
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/algorithm/cholesky.hpp>

namespace {

void leave(const Simulation &simulation, double *a) {
    Eigen::Map<Eigen::VectorXd>(a, simulation.model.nv) = simulation.data.ddq;
}

} // namespace

extern "C" void local(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    aba(s.model, s.data, s.q, s.v, s.tau, Convention::LOCAL);
    leave(s, a + OWN);
}

extern "C" void world(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    aba(s.model, s.data, s.q, s.v, s.tau, Convention::WORLD);
    leave(s, a + OWN);
}

extern "C" void composite(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    crba(s.model, s.data, s.q, Convention::LOCAL);
    nonLinearEffects(s.model, s.data, s.q, s.v);
    cholesky::decompose(s.model, s.data);
    s.data.ddq = s.tau - s.data.nle;
    cholesky::solve(s.model, s.data, s.data.ddq);
    leave(s, a + OWN);
}

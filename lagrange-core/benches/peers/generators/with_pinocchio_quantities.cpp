// Pinocchio: what else is asked of bodies in space than their accelerations.
#include "pinocchio_model.h"
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/rnea.hpp>

namespace {

// Of the arm whose Jacobian is taken, and where its point stands in p.
enum { JOINTS = 6, POINT = JOINTS * 25 + 7 };
using Six = Eigen::Matrix<double, 6, JOINTS>;

// The same with a frame at the point.
FrameIndex point(Simulation &simulation, const double *p) {
    static const FrameIndex added = [&] {
        const JointIndex last = simulation.model.njoints - 1;
        const SE3 place(Eigen::Matrix3d::Identity(), Vector(p + POINT));
        const FrameIndex frame = simulation.model.addFrame(Frame("point", last, 0, place, OP_FRAME));
        simulation.data = Data(simulation.model);
        return frame;
    }();
    return added;
}

template <typename Matrix> double *leave(const Matrix &matrix, double *a) {
    Eigen::Map<Eigen::MatrixXd>(a, matrix.rows(), matrix.cols()) = matrix;
    return a + matrix.size();
}

} // namespace

extern "C" void inverse(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    leave(rnea(s.model, s.data, s.q, s.v, Values(q + OWN + s.model.nq + s.model.nv, s.model.nv)), a + OWN);
}

extern "C" void mass_local(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    leave(crba(s.model, s.data, s.q, Convention::LOCAL), a + OWN);
}

extern "C" void mass_world(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    leave(crba(s.model, s.data, s.q, Convention::WORLD), a + OWN);
}

extern "C" void jacobian_frame(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    Six jacobian = Six::Zero();
    computeFrameJacobian(s.model, s.data, s.q, point(s, p), LOCAL_WORLD_ALIGNED, jacobian);
    leave(jacobian.topRows<3>(), a + OWN);
}

extern "C" void jacobian_joints(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    const FrameIndex frame = point(s, p);
    Six jacobian = Six::Zero();
    computeJointJacobians(s.model, s.data, s.q);
    getFrameJacobian(s.model, s.data, frame, LOCAL_WORLD_ALIGNED, jacobian);
    leave(jacobian.topRows<3>(), a + OWN);
}

extern "C" void derivatives(const double *q, const double *, const double *p, double *a, double *) {
    Simulation &s = simulation(p, q + OWN);
    computeABADerivatives(s.model, s.data, s.q, s.v, s.tau);
    a = leave(s.data.ddq_dq, a + OWN);
    a = leave(s.data.ddq_dv, a);
    leave(s.data.Minv.rightCols(s.joints), a);
}

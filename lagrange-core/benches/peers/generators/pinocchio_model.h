// The robot that stands after p, for Pinocchio. The algorithms are compiled here, from the headers, rather than taken from the
// library of the package, so that they have the flags of the others.
#ifndef PINOCCHIO_MODEL_H
#define PINOCCHIO_MODEL_H

#include <pinocchio/multibody.hpp>

extern "C" {
#include "systems.h"
}

namespace {

using namespace pinocchio;
using Values = Eigen::Map<const Eigen::VectorXd>;
using Matrix = Eigen::Map<const Eigen::Matrix3d>;
using Vector = Eigen::Map<const Eigen::Vector3d>;

JointIndex add_joint(Model &model, const Link &link, JointIndex parent, const std::string &name) {
    const SE3 place(Matrix(link.place), Vector(link.at));
    switch (link.axis) {
    case 'x': return model.addJoint(parent, JointModelRX(), place, name);
    case 'y': return model.addJoint(parent, JointModelRY(), place, name);
    case 'z': return model.addJoint(parent, JointModelRZ(), place, name);
    default: return model.addJoint(parent, JointModelFreeFlyer(), place, name);
    }
}

struct Simulation {
    Model model;
    Data data;
    Eigen::VectorXd q, v, tau;
    // That are moved by forces; the others are those of a free base.
    int joints;

    explicit Simulation(const Robot &robot) : model(of(robot)), data(model), q(model.nq), v(model.nv), tau(model.nv),
          joints(robot.count - (robot.links[0].axis == 'F')) {
        tau.setZero();
        for (int k = 0; k < robot.count; k++) tau[model.nv - robot.count + k] = robot.links[k].tau;
    }

    static Model of(const Robot &robot) {
        Model model;
        std::vector<JointIndex> joints;
        for (int k = 0; k < robot.count; k++) {
            const Link &link = robot.links[k];
            const JointIndex parent = link.parent < 0 ? 0 : joints[link.parent];
            joints.push_back(add_joint(model, link, parent, "joint" + std::to_string(k)));
            const Inertia inertia(link.m, Vector(link.centre), Matrix(link.inertia));
            model.appendBodyToJoint(joints[k], inertia, SE3::Identity());
        }
        model.gravity.linear() = Eigen::Vector3d(0, 0, -robot.g);
        return model;
    }
};

// The model is built once, as its users do; p does not change.
Simulation &simulation(const double *p, const double *own) {
    static Simulation simulation(*reinterpret_cast<const Robot *>(p + PARAMETERS));
    simulation.q = Values(own, simulation.model.nq);
    simulation.v = Values(own + simulation.model.nq, simulation.model.nv);
    return simulation;
}

} // namespace

#endif

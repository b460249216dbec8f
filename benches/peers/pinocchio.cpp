// Pinocchio: its Jacobian of a frame.
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/config.hpp>

#define NAME "Pinocchio " PINOCCHIO_VERSION
#include "ways.hpp"

template <int N>
struct Arm {
    using Angles = Eigen::Map<const Eigen::Matrix<double, N, 1>>;

    pinocchio::Model model;
    pinocchio::Data data;
    pinocchio::FrameIndex tip;
    Eigen::Matrix<double, 6, N> jacobian = Eigen::Matrix<double, 6, N>::Zero();

    explicit Arm(const double (&rows)[N][5]) {
        pinocchio::SE3 before = pinocchio::SE3::Identity();
        pinocchio::JointIndex joint = 0;
        for (int i = 0; i < N; i++) {
            const pinocchio::SE3 turn(turned(rows[i][0], Eigen::Vector3d::UnitZ()), Eigen::Vector3d::Zero());
            joint = model.addJoint(joint, pinocchio::JointModelRZ(), before * turn, "joint" + std::to_string(i));
            const Eigen::Vector3d along(rows[i][2], 0, rows[i][1]);
            before = pinocchio::SE3(turned(rows[i][3], Eigen::Vector3d::UnitX()), along);
        }
        tip = model.addFrame(pinocchio::Frame("tip", joint, 0, before, pinocchio::OP_FRAME));
        data = pinocchio::Data(model);
    }

    static Eigen::Matrix3d turned(double quarters, const Eigen::Vector3d &axis) {
        return Eigen::AngleAxisd(quarters * M_PI_2, axis).toRotationMatrix();
    }

    void transform(const double *q) {
        pinocchio::forwardKinematics(model, data, Angles(q));
        pinocchio::updateFramePlacement(model, data, tip);
    }

    void differentiate(const double *q) {
        pinocchio::computeFrameJacobian(model, data, Angles(q), tip, pinocchio::LOCAL_WORLD_ALIGNED, jacobian);
    }

    // The Jacobian leaves the frames of the joints behind.
    void both(const double *q) {
        differentiate(q);
        pinocchio::updateFramePlacement(model, data, tip);
    }

    void put_transform(double *out) const {
        Eigen::Map<Eigen::Matrix4d> map(out);
        map = data.oMf[tip].toHomogeneousMatrix();
    }
};

ROBOTS();

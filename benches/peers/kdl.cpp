// Orocos KDL: its solvers for the frame and the Jacobian.
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/config.h>

#define NAME "Orocos KDL " KDL_VERSION_STRING
#include "ways.hpp"

template <int N>
struct Arm {
    KDL::Chain chain;
    KDL::ChainFkSolverPos_recursive frames;
    KDL::ChainJntToJacSolver jacobians;
    KDL::JntArray angles;
    KDL::Frame tip;
    KDL::Jacobian solved;
    const Eigen::Matrix<double, 6, Eigen::Dynamic> &jacobian = solved.data;

    explicit Arm(const double (&rows)[N][5])
        : chain(chained(rows)), frames(chain), jacobians(chain), angles(N), solved(N) {}

    static KDL::Chain chained(const double (&rows)[N][5]) {
        KDL::Chain chain;
        for (int i = 0; i < N; i++) {
            // What turns a joint's zero ends the link before it; neither robot has that at joint 1.
            const double theta = i + 1 < N ? rows[i + 1][0] : 0;
            const KDL::Frame link(KDL::Rotation::RotX(rows[i][3] * M_PI_2), KDL::Vector(rows[i][2], 0, rows[i][1]));
            const KDL::Frame turn(KDL::Rotation::RotZ(theta * M_PI_2));
            chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), link * turn));
        }
        return chain;
    }

    void read(const double *q) {
        for (int i = 0; i < N; i++) angles(i) = q[i];
    }

    void transform(const double *q) {
        read(q);
        frames.JntToCart(angles, tip);
    }

    void differentiate(const double *q) {
        read(q);
        jacobians.JntToJac(angles, solved);
    }

    void both(const double *q) {
        transform(q);
        jacobians.JntToJac(angles, solved);
    }

    void put_transform(double *out) const {
        for (int j = 0; j < 3; j++) {
            for (int i = 0; i < 3; i++) out[4 * j + i] = tip.M(i, j);
            out[4 * j + 3] = 0;
            out[12 + j] = tip.p(j);
        }
        out[15] = 1;
    }
};

ROBOTS();

// What the C++ peers have in common: each has an `Arm<N>`, which is made of the rows
// of a DH table and has
// - `transform(q)`, `differentiate(q)` and `both(q)`, which compute,
// - `put_transform(out)`, 4 x 4 by columns,
// - `jacobian`, Eigen's, translation first.
#pragma once
#include <Eigen/Core>

#include "harness.h"
#include "robots.h"

template <int N, class Arm, Arm &arm, const double (&rows)[N][5]>
struct Ways {
    static void put_jacobian(double *out) {
        Eigen::Map<Eigen::Matrix<double, 6, N>> map(out);
        map = arm.jacobian;
    }
    static void put_compliance(double *out) {
        Eigen::Matrix<double, N, 1> soft;
        for (int i = 0; i < N; i++) soft[i] = rows[i][4];
        const Eigen::Matrix<double, 6, N> fixed = arm.jacobian;
        const Eigen::Matrix<double, 6, 6> full = fixed * soft.asDiagonal() * fixed.transpose();
        for (int i = 0; i < 6; i++)
            for (int j = i; j < 6; j++) *out++ = full(i, j);
    }
    static void transform(const double *q, double *out) {
        arm.transform(q);
        arm.put_transform(out);
    }
    static void jacobian(const double *q, double *out) {
        arm.differentiate(q);
        put_jacobian(out);
    }
    static void compliance(const double *q, double *out) {
        arm.differentiate(q);
        put_compliance(out);
    }
    static void all(const double *q, double *out) {
        arm.both(q);
        arm.put_transform(out);
        put_jacobian(out + 16);
        put_compliance(out + 16 + 6 * N);
    }
};

#define ROBOT(name, N, arm, rows)                                                        \
    {name, "T", NAME, N, 16, Ways<N, Arm<N>, arm, rows>::transform, 0, 0},               \
        {name, "J", NAME, N, 6 * N, Ways<N, Arm<N>, arm, rows>::jacobian, 0, 0},         \
        {name, "H", NAME, N, 21, Ways<N, Arm<N>, arm, rows>::compliance, 0, 0},          \
        {name, "TJH", NAME, N, 16 + 6 * N + 21, Ways<N, Arm<N>, arm, rows>::all, 0, 0}

#define ROBOTS()                                                              \
    static Arm<5> five(R5);                                                   \
    static Arm<6> six(R6);                                                    \
    const struct way WAYS[] = {ROBOT("R5", 5, five, R5), ROBOT("R6", 6, six, R6)}; \
    const int WAY_COUNT = sizeof WAYS / sizeof *WAYS

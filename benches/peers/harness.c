/* The others' side: `harness check` prints the triangles of the first poses,
   `harness time` the least time of a pass over all poses, in ns a pose. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { COUNT = 1024 };

void sympy_one(double, double, double, double, double, double *);
void sympy_many(const double (*)[COUNT], double (*)[COUNT]);
int casadi_one(const double **, double **, long long *, double *, int);

static double q[COUNT][5], by_joint[5][COUNT], out[COUNT][21], by_entry[21][COUNT];

static void sympy_pass(void) {
    for (int k = 0; k < COUNT; k++) sympy_one(q[k][0], q[k][1], q[k][2], q[k][3], q[k][4], out[k]);
}

static void casadi_pass(void) {
    static double work[4096];
    static long long whole[64];
    for (int k = 0; k < COUNT; k++) {
        const double *arguments[8] = {q[k]};
        double *results[8] = {out[k]};
        casadi_one(arguments, results, whole, work, 0);
    }
}

static void sympy_vector_pass(void) { sympy_many((const double (*)[COUNT])by_joint, by_entry); }

static const struct {
    const char *name;
    void (*pass)(void);
} PEERS[] = {{"SymPy", sympy_pass}, {"CasADi", casadi_pass}, {"SymPy, gcc with a vector libm", sympy_vector_pass}};

int main(int count, char **arguments) {
    for (int k = 0; k < COUNT; k++)
        for (int i = 0; i < 5; i++) by_joint[i][k] = q[k][i] = 2.0 * sin(1.7 * k + 2.3 * i);
    for (int p = 0; p < 3; p++) {
        if (count > 1 && strcmp(arguments[1], "check") == 0) {
            PEERS[p].pass();
            for (int k = 0; k < 64; k++)
                for (int e = 0; e < 21; e++) printf("%s\t%.17g\n", PEERS[p].name, p == 2 ? by_entry[e][k] : out[k][e]);
            continue;
        }
        double least = INFINITY;
        for (int round = 0; round < 300; round++) {
            struct timespec start, end;
            clock_gettime(CLOCK_MONOTONIC, &start);
            PEERS[p].pass();
            clock_gettime(CLOCK_MONOTONIC, &end);
            least = fmin(least, ((end.tv_sec - start.tv_sec) * 1e9 + (end.tv_nsec - start.tv_nsec)) / COUNT);
        }
        printf("%s\t%.17g\n", PEERS[p].name, least);
    }
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/implicit_tableau.h"

#include "base/status.h"
#include "dynamics/compile/vec3.h"

#include <math.h>

enum { S = HN_IMPLICIT_STAGES };

// inverse of the leading n x n block by Gauss-Jordan with row exchanges
static void invert(int n, double (*A)[S], double (*out)[S]) {
    double w[S][2 * S] = {{0}};

    // [A | 1]
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            w[i][j] = A[i][j];
        }
        w[i][n + i] = 1;
    }

    // Gauss-Jordan elimination with row pivoting
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) {
            best = fabs(w[i][k]) > fabs(w[best][k]) ? i : best;
        }
        for (int j = 0; j < 2 * n; j++) {
            const double keep = w[k][j];
            w[k][j] = w[best][j];
            w[best][j] = keep;
        }
        const double pivot = w[k][k];
        for (int j = 0; j < 2 * n; j++) {
            w[k][j] /= pivot;
        }
        for (int i = 0; i < n; i++) {
            const double factor = w[i][k];
            for (int j = 0; j < 2 * n && i != k; j++) {
                w[i][j] -= factor * w[k][j];
            }
        }
    }

    // the inverse stands on the right
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            out[i][j] = w[i][n + j];
        }
    }
}

double hn_collocation_estimate_weight(double rtol) {
    return fmin(1, 10 * cbrt(rtol));
}

double hn_collocation_newton_share(double rtol) {
    return fmin(0.03, sqrt(rtol / hn_collocation_estimate_weight(rtol)));
}

void hn_collocation_basis(const hn_collocation *col, double x, double *l) {
    for (int j = 0; j < col->stages; j++) {
        l[j] = 1;
        for (int k = 0; k < col->stages; k++) {
            if (k != j) {
                l[j] *= (x - col->c[k]) / (col->c[j] - col->c[k]);
            }
        }
    }
}

void hn_collocation_dense(const hn_collocation *col, double theta, double *w) {
    hn_collocation_basis(col, theta, w);
    for (int j = 0; j < col->stages; j++) {
        w[j] *= theta / col->c[j];
    }
}

// eq. (1): exact on polynomials, so A V = C and b V = 1/k with V_jk = c_j^(k-1), C_ik = c_i^k / k
static void integrate_basis(hn_collocation *col) {
    const int s = col->stages;
    double V[S][S], V_inverse[S][S];

    // Vandermonde matrix of the nodes
    for (int j = 0; j < s; j++) {
        for (int k = 0; k < s; k++) {
            V[j][k] = pow(col->c[j], k);
        }
    }
    invert(s, V, V_inverse);

    // integrals of the Lagrange polynomials: b over the step, A up to each node
    for (int j = 0; j < s; j++) {
        col->b[j] = 0;
        for (int k = 0; k < s; k++) {
            col->b[j] += V_inverse[k][j] / (k + 1);
        }
        for (int i = 0; i < s; i++) {
            col->A[i][j] = 0;
            for (int k = 0; k < s; k++) {
                col->A[i][j] += pow(col->c[i], k + 1) / (k + 1) * V_inverse[k][j];
            }
        }
    }
}

// the one real root of x^3 - t x^2 + m x - d, by Newton's method from above all roots
static double real_root(double t, double m, double d) {
    double x = 1 + fabs(t) + fabs(m) + fabs(d);
    for (int i = 0; i < 200; i++) {
        const double f = ((x - t) * x + m) * x - d, slope = (3 * x - 2 * t) * x + m;
        const double next = x - f / slope;
        if (next == x) {
            break;
        }
        x = next;
    }
    return x;
}

// columns of T: the eigenvector of a number is perpendicular to the rows of A^-1 minus that number
static void find_vectors_of_three(hn_collocation *col) {
    double row[2][3], part[3], other[3], turned[3];

    // two rows of A^-1 determine the eigenvectors up to scale
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 3; j++) {
            row[i][j] = col->A_inverse[i][j];
        }
    }
    double real[2][3], complex_part[2][3];
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 3; j++) {
            real[i][j] = row[i][j] - (i == j ? col->gamma : 0);
            complex_part[i][j] = row[i][j] - (i == j ? col->alpha : 0);
        }
    }

    // real eigenvector
    hn_num3_cross(real[0], real[1], part);
    for (int i = 0; i < 3; i++) {
        col->T[i][0] = part[i];
    }
    // (u0 - i beta e0) x (u1 - i beta e1), u the rows minus alpha
    const double e0[3] = {1, 0, 0}, e1[3] = {0, 1, 0};
    hn_num3_cross(complex_part[0], complex_part[1], part);
    hn_num3_cross(complex_part[0], e1, other);
    hn_num3_cross(e0, complex_part[1], turned);
    part[2] -= col->beta * col->beta; // e0 x e1 = e2
    for (int i = 0; i < 3; i++) {
        col->T[i][1] = part[i];
        col->T[i][2] = -col->beta * (other[i] + turned[i]);
    }
}

static void split_three(hn_collocation *col) {
    double(*P)[S] = col->A_inverse;
    const double trace = P[0][0] + P[1][1] + P[2][2];
    const double minors = P[0][0] * P[1][1] - P[0][1] * P[1][0] + P[0][0] * P[2][2] -
                          P[0][2] * P[2][0] + P[1][1] * P[2][2] - P[1][2] * P[2][1];
    double normal[3];
    hn_num3_cross(P[1], P[2], normal);
    const double det = P[0][0] * normal[0] + P[0][1] * normal[1] + P[0][2] * normal[2];
    col->n_real = col->n_pairs = 1;
    col->gamma = real_root(trace, minors, det);
    col->alpha = (trace - col->gamma) / 2;
    col->beta = sqrt(det / col->gamma - col->alpha * col->alpha);
    find_vectors_of_three(col);
}

static void split_two(hn_collocation *col) {
    double(*P)[S] = col->A_inverse;
    col->n_real = 0;
    col->n_pairs = 1;
    col->alpha = (P[0][0] + P[1][1]) / 2;
    const double det = P[0][0] * P[1][1] - P[0][1] * P[1][0];
    col->beta = sqrt(det - col->alpha * col->alpha);
    col->T[0][0] = P[0][1];
    col->T[1][0] = col->alpha - P[0][0];
    col->T[0][1] = 0;
    col->T[1][1] = col->beta;
}

void hn_collocation_init(hn_collocation *col, int stages, int order, const double *c) {
    HN_ASSERT(stages >= 1 && stages <= S);
    *col = (hn_collocation){.stages = stages, .order = order};
    for (int i = 0; i < stages; i++) {
        col->c[i] = c[i];
    }

    // weights of the quadrature and their inverse
    integrate_basis(col);
    invert(stages, col->A, col->A_inverse);

    // the end of the step as a combination of the stages
    for (int j = 0; j < stages; j++) {
        for (int i = 0; i < stages; i++) {
            col->end[j] += col->b[i] * col->A_inverse[i][j];
        }
    }
    if (col->c[stages - 1] == 1) { // the last stage is the end itself
        for (int j = 0; j < stages; j++) {
            col->end[j] = j == stages - 1;
        }
    }

    // real blocks and complex pairs of A^-1
    if (stages == 1) {
        col->n_real = 1;
        col->gamma = col->A_inverse[0][0];
        col->T[0][0] = 1;
    } else if (stages == 2) {
        split_two(col);
    } else {
        split_three(col);
    }
    invert(stages, col->T, col->T_inverse);
}

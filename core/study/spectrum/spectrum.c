// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/spectrum/spectrum.h"

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/linearise.h"
#include "linalg/dense.h"
#include "linalg/qr.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define RANK_TOL 1e-10 // of the largest pivot of W^1/2 J'
#define MASS_TOL 1e-14 // of the largest entry on the diagonal of M_r

struct hn_spectrum {
    int nv, nc;
    int rank; ///< of J, the largest met
    hn_accel *accel;
    hn_linear *linear;
    hn_qr qr;           ///< of W^1/2 J', W = diag(1 / M_jj): metres and radians become comparable
    double *scale;      ///< nv: W^1/2
    double *N;          ///< nv x r, row-major: W^1/2 times an orthonormal basis
    double *a, *lambda; ///< nv, nc
    double *product;    ///< nv x nv
    double *M, *C, *K;  ///< r x r
    double *companion;  ///< 2r x 2r
    hn_eigenvalue *values; ///< 2r
    gsl_vector_complex *gsl_values;
    gsl_eigen_nonsymm_workspace *gsl_work;
    size_t gsl_size; ///< what both were made for
};

hn_status hn_spectrum_create(const hn_system *sys, hn_arena *arena, hn_spectrum **out) {
    const hn_system_info info = hn_system_get_info(sys);
    const size_t nv = (size_t)info.nv, nc = (size_t)info.nc;
    const hn_accel_opts opts = {.want_lambda = 1};
    hn_spectrum *s = hn_arena_get(arena, sizeof *s);
    *out = NULL;
    if (!s) {
        return HN_ERR_MEMORY;
    }
    gsl_set_error_handler_off();
    *s = (hn_spectrum){.nv = info.nv, .nc = info.nc};

    // memory: vectors, matrices, eigenvalues
    const int ok = hn_qr_init(&s->qr, arena, info.nv, info.nc);
    double **const vectors[] = {&s->scale, &s->a, &s->lambda};
    for (size_t k = 0; k < sizeof vectors / sizeof vectors[0]; k++) {
        *vectors[k] = hn_arena_doubles(arena, nv + nc);
    }
    double **const matrices[] = {&s->N, &s->product, &s->M, &s->C, &s->K};
    for (size_t k = 0; k < sizeof matrices / sizeof matrices[0]; k++) {
        *matrices[k] = hn_arena_doubles(arena, nv * nv);
    }
    s->companion = hn_arena_doubles(arena, 4 * nv * nv);
    s->values = hn_arena_get(arena, 2 * (nv + 1) * sizeof *s->values);

    // evaluators of accelerations and of the linearised equations
    hn_status status = ok && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
    HN_THEN(status, hn_accel_create(sys, &opts, arena, &s->accel));
    HN_THEN(status, hn_linear_create(sys, HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J,
                                     arena, &s->linear));

    if (status != HN_OK) {
        hn_spectrum_free(s);
        return status;
    }
    *out = s;
    return HN_OK;
}

static void free_gsl(hn_spectrum *s) {
    if (s->gsl_values) {
        gsl_vector_complex_free(s->gsl_values);
    }
    if (s->gsl_work) {
        gsl_eigen_nonsymm_free(s->gsl_work);
    }
    s->gsl_values = NULL;
    s->gsl_work = NULL;
}

void hn_spectrum_free(hn_spectrum *s) {
    if (s) {
        hn_accel_free(s->accel);
        hn_linear_free(s->linear);
        s->accel = NULL;
        s->linear = NULL;
        free_gsl(s);
    }
}

// basis of ker J in s->N; returns its dimension r, or -1 where J has lost rank
static int find_basis(hn_spectrum *s) {
    const size_t nv = (size_t)s->nv;
    const double *M = hn_linear_get(s->linear, HN_LINEAR_M),
                 *J = hn_linear_get(s->linear, HN_LINEAR_J);

    // rows of J in coordinates scaled by the mass
    for (size_t j = 0; j < nv; j++) {
        s->scale[j] = M[j * nv + j] > 0 ? 1 / sqrt(M[j * nv + j]) : 1;
    }
    for (size_t i = 0; i < (size_t)s->nc; i++) {
        for (size_t j = 0; j < nv; j++) {
            s->qr.a[i * nv + j] = J[i * nv + j] * s->scale[j];
        }
    }

    // the rank must not fall below that of earlier states
    hn_qr_factor(&s->qr, s->nv, s->nc, RANK_TOL);
    if (s->qr.rank < s->rank) {
        return -1;
    }
    s->rank = s->qr.rank;

    // the basis: the last columns of Q, in the original coordinates
    const int r = s->nv - s->rank;
    double *e = s->product;
    for (int k = 0; k < r; k++) {
        memset(e, 0, nv * sizeof *e);
        e[s->rank + k] = 1;
        hn_qr_apply_q(&s->qr, e);
        for (int i = 0; i < s->nv; i++) {
            s->N[i * r + k] = s->scale[i] * e[i];
        }
    }
    return r;
}

// out (r x r) = N' X N
static void reduce(hn_spectrum *s, hn_linear_term term, int r, double *out) {
    const double *X = hn_linear_get(s->linear, term);
    for (int i = 0; i < s->nv; i++) {
        for (int k = 0; k < r; k++) {
            double sum = 0;
            for (int j = 0; j < s->nv; j++) {
                sum += X[(size_t)i * (size_t)s->nv + (size_t)j] * s->N[j * r + k];
            }
            s->product[i * r + k] = sum;
        }
    }
    for (int i = 0; i < r; i++) {
        for (int k = 0; k < r; k++) {
            double sum = 0;
            for (int j = 0; j < s->nv; j++) {
                sum += s->N[j * r + i] * s->product[j * r + k];
            }
            out[i * r + k] = sum;
        }
    }
}

// X <- L^-1 X L^-T for L L' = M_r
static void normalise(int r, const double *L, double *X, double *column) {
    for (int k = 0; k < r; k++) {
        for (int i = 0; i < r; i++) {
            column[i] = X[i * r + k];
        }
        hn_lower_solve(r, L, r, column);
        for (int i = 0; i < r; i++) {
            X[i * r + k] = column[i];
        }
    }
    for (int i = 0; i < r; i++) {
        hn_lower_solve(r, L, r, X + (size_t)i * (size_t)r);
    }
}

// [0 w; -K/w -C] with M_r = 1 and w^2 = |K|: both halves are of one size then
static void fill_companion(hn_spectrum *s, int r) {
    const size_t n = 2 * (size_t)r, size = (size_t)r;
    const double largest = hn_norm_max(r * r, s->K), w = largest > 0 ? sqrt(largest) : 1;
    memset(s->companion, 0, n * n * sizeof(double));
    for (size_t i = 0; i < size; i++) {
        s->companion[i * n + size + i] = w;
        for (size_t k = 0; k < size; k++) {
            s->companion[(size + i) * n + k] = -s->K[i * size + k] / w;
            s->companion[(size + i) * n + size + k] = -s->C[i * size + k];
        }
    }
}

static int compare(const void *a, const void *b) {
    const hn_eigenvalue *x = a, *y = b;
    const double p = hypot(x->re, x->im), q = hypot(y->re, y->im);
    if (p != q) {
        return p < q ? 1 : -1;
    }
    return x->im != y->im ? (x->im < y->im ? 1 : -1) : (x->re < y->re) - (x->re > y->re);
}

static hn_status find_eigenvalues(hn_spectrum *s, int r) {
    const size_t n = 2 * (size_t)r;

    // workspaces for this size
    if (s->gsl_size != n) {
        free_gsl(s);
        s->gsl_values = gsl_vector_complex_alloc(n);
        s->gsl_work = gsl_eigen_nonsymm_alloc(n);
        s->gsl_size = s->gsl_values && s->gsl_work ? n : 0;
        if (s->gsl_size == 0) {
            return HN_ERR_MEMORY;
        }
        gsl_eigen_nonsymm_params(0, 1, s->gsl_work);
    }

    // eigenvalues in a fixed order
    gsl_matrix_view A = gsl_matrix_view_array(s->companion, n, n);
    if (gsl_eigen_nonsymm(&A.matrix, s->gsl_values, s->gsl_work) != 0) {
        return HN_ERR_NO_CONVERGENCE;
    }
    for (size_t k = 0; k < n; k++) {
        const gsl_complex z = gsl_vector_complex_get(s->gsl_values, k);
        s->values[k] = (hn_eigenvalue){GSL_REAL(z), GSL_IMAG(z)};
    }
    qsort(s->values, n, sizeof *s->values, compare);
    return HN_OK;
}

static bool is_finite(const hn_spectrum *s) {
    return hn_linear_is_finite(s->linear, HN_LINEAR_M) &&
           hn_linear_is_finite(s->linear, HN_LINEAR_K) &&
           hn_linear_is_finite(s->linear, HN_LINEAR_C) &&
           hn_linear_is_finite(s->linear, HN_LINEAR_J);
}

hn_status hn_spectrum_calc(hn_spectrum *s, double t, const double *q, const double *v,
                           const hn_eigenvalue **out, int *n) {
    hn_accel_info info;
    *out = s->values;
    *n = 0;

    // linearise about the state and its accelerations
    hn_status status = hn_accel_eval(s->accel, t, q, v, 0, 0, s->a, s->lambda, &info);
    if (status != HN_OK) {
        return status == HN_ERR_DIVERGED ? status : HN_ERR_SINGULAR;
    }
    hn_linear_run(s->linear, t, q, v, s->a, s->lambda);
    if (!is_finite(s)) {
        return HN_ERR_DIVERGED;
    }

    // reduce to the directions that the loops allow
    const int r = find_basis(s);
    if (r < 0) {
        return HN_ERR_SINGULAR;
    }
    if (r == 0) {
        return HN_OK;
    }
    reduce(s, HN_LINEAR_M, r, s->M);
    reduce(s, HN_LINEAR_C, r, s->C);
    reduce(s, HN_LINEAR_K, r, s->K);

    // from M x" + C x' + K x = 0 to a first-order system
    if (hn_cholesky(r, s->M, r, MASS_TOL * hn_norm_max(r * r, s->M)) != HN_OK) {
        return HN_ERR_SINGULAR;
    }
    normalise(r, s->M, s->C, s->product);
    normalise(r, s->M, s->K, s->product);
    fill_companion(s, r);

    status = find_eigenvalues(s, r);
    *n = status == HN_OK ? 2 * r : 0;
    return status;
}

/// The vector of unit length that the r x r matrix P all but takes to zero; P is spoiled.
static hn_status find_null_vector(gsl_matrix *P, double *y) {
    const size_t r = P->size1;
    gsl_matrix *V = gsl_matrix_alloc(r, r);
    gsl_vector *sigma = gsl_vector_alloc(r), *work = gsl_vector_alloc(r);
    hn_status status = V && sigma && work ? HN_OK : HN_ERR_MEMORY;
    if (status == HN_OK && gsl_linalg_SV_decomp(P, V, sigma, work) != 0) {
        status = HN_ERR_NO_CONVERGENCE;
    }
    for (size_t i = 0; i < r && status == HN_OK; i++) {
        y[i] = gsl_matrix_get(V, i, r - 1);
    }
    gsl_vector_free(work);
    gsl_vector_free(sigma);
    gsl_matrix_free(V);
    return status;
}

hn_status hn_spectrum_mode(hn_spectrum *s, hn_eigenvalue value, double *x) {
    const size_t r = (size_t)(s->nv - s->rank);
    const bool damped = fabs(value.re) > fabs(value.im);
    const double square = value.re * value.re + (damped ? -1 : 1) * value.im * value.im;
    gsl_matrix *P = r > 0 ? gsl_matrix_alloc(r, r) : NULL;
    double *y = s->product;
    if (!P) {
        return HN_ERR_MEMORY;
    }

    // s^2 + s C + K of a damped mode; K - |s|^2 of a vibration
    for (size_t i = 0; i < r * r; i++) {
        const double one = i % (r + 1) == 0;
        P->data[i] = damped ? square * one + value.re * s->C[i] + s->K[i] : s->K[i] - square * one;
    }
    const hn_status status = find_null_vector(P, y);
    gsl_matrix_free(P);
    if (status != HN_OK) {
        return status;
    }

    // from M_r = L L' back to velocities: x = N L^-T y
    hn_lower_t_solve((int)r, s->M, (int)r, y);
    hn_mat_vec(s->nv, (int)r, s->N, y, x);
    return HN_OK;
}

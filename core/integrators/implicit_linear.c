#include "integrators/implicit_linear.h"

#include "linalg/dense.h"

#include <math.h>
#include <string.h>

#define ROW_FLOOR \
    1e-3 // of the longest row: a shorter one is dying away and stays as short against the others
#define RANK_TOL 1e-10 // of the largest row, all brought to length 1

static int has_stabiliser(const hn_implicit_linear *l) {
    return l->form == HN_FORM_GGL;
}

static void allocate(hn_implicit_linear *l, hn_arena *arena) {
    const size_t nv = (size_t)l->nv, nc = (size_t)l->nc, n = nv + nc;
    l->kept = hn_arena_ints(arena, nc);
    l->unit = hn_arena_doubles(arena, nc);
    if (has_stabiliser(l)) {
        l->Y = hn_arena_doubles(arena, nv * nc);
        l->S = hn_arena_doubles(arena, nc * nc);
        l->damped = hn_arena_doubles(arena, nv * nv);
        l->mass = hn_arena_doubles(arena, nv * nv);
    }
    l->real = hn_arena_doubles(arena, n * n);
    l->scale = hn_arena_doubles(arena, n);
    l->matrix = hn_arena_get(arena, (n * n + 1) * sizeof *l->matrix);
    l->packed = hn_arena_get(arena, (n + 1) * sizeof *l->packed);
    l->pivot[0] = hn_arena_ints(arena, n);
    l->pivot[1] = hn_arena_ints(arena, n);
    for (int part = 0; part < 2; part++) {
        for (int k = 0; k < 5; k++) {
            l->work[part][k] = hn_arena_doubles(arena, n);
        }
    }
}

hn_status hn_implicit_linear_init(hn_implicit_linear *l, const hn_system *sys, hn_dae_form form,
                                  hn_arena *arena) {
    const hn_system_info info = hn_system_get_info(sys);
    const unsigned terms =
        HN_LINEAR_RESIDUAL | HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J | HN_LINEAR_V;
    *l = (hn_implicit_linear){.form = form, .nv = info.nv, .nc = info.nc};
    allocate(l, arena);
    if (!hn_qr_init(&l->qr, arena, info.nv, info.nc) || hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    const hn_status status = hn_linear_create(sys, terms, arena, &l->terms);
    if (status != HN_OK) {
        return status;
    }
    l->M = hn_linear_get(l->terms, HN_LINEAR_M);
    l->K = hn_linear_get(l->terms, HN_LINEAR_K);
    l->C = hn_linear_get(l->terms, HN_LINEAR_C);
    l->J = hn_linear_get(l->terms, HN_LINEAR_J);
    l->V = hn_linear_get(l->terms, HN_LINEAR_V);
    const int *rows, *cols;
    l->has_damping = hn_linear_pattern(l->terms, HN_LINEAR_C, &rows, &cols) > 0;
    return HN_OK;
}

void hn_implicit_linear_free(hn_implicit_linear *l) {
    hn_linear_free(l->terms);
    l->terms = NULL;
}

// by pivoted QR of J' with rows of length 1
double hn_implicit_linear_choose(hn_implicit_linear *l, double t, const double *q,
                                 const double *v) {
    const int nv = l->nv, nc = l->nc;
    hn_linear_run(l->terms, t, q, v, NULL, NULL);
    double longest = 0;
    for (int i = 0; i < nc; i++) {
        l->unit[i] = hn_norm2(nv, l->J + (size_t)i * (size_t)nv);
        longest = fmax(longest, l->unit[i]);
    }
    for (int i = 0; i < nc; i++) {
        const double *row = l->J + (size_t)i * (size_t)nv;
        const double size = fmax(l->unit[i], ROW_FLOOR * longest);
        l->unit[i] = size > 0 ? 1 / size : 0;
        for (int j = 0; j < nv; j++) {
            l->qr.a[i * nv + j] = row[j] * l->unit[i];
        }
    }
    hn_qr_factor(&l->qr, nv, nc, RANK_TOL);
    l->n_kept = l->qr.rank;
    for (int k = 0; k < l->n_kept; k++) {
        l->kept[k] = l->qr.perm[k];
    }
    return hn_qr_pivot_ratio(&l->qr);
}

// Y = M^-1 J', S = J Y of the kept rows
static hn_status prepare_stabiliser(hn_implicit_linear *l) {
    const int nv = l->nv, nk = l->n_kept;
    double *column = l->work[0][0];
    memcpy(l->mass, l->M, (size_t)(nv * nv) * sizeof *l->mass);
    double largest = 0;
    for (int i = 0; i < nv; i++) {
        largest = fmax(largest, fabs(l->M[i * nv + i]));
    }
    if (hn_cholesky(nv, l->mass, nv, 1e-14 * largest) != HN_OK) {
        return HN_ERR_SINGULAR;
    }
    memset(l->Y, 0, (size_t)(nv * l->nc) * sizeof *l->Y);
    for (int k = 0; k < nk; k++) {
        memcpy(column, l->J + (size_t)l->kept[k] * (size_t)nv, (size_t)nv * sizeof *column);
        hn_cholesky_solve(nv, l->mass, nv, column);
        for (int i = 0; i < nv; i++) {
            l->Y[i * l->nc + l->kept[k]] = column[i];
        }
        for (int i = 0; i < nk; i++) {
            l->S[i * nk + k] = hn_dot(nv, l->J + (size_t)l->kept[i] * (size_t)nv, column);
        }
    }
    largest = 0;
    for (int i = 0; i < nk; i++) {
        largest = fmax(largest, l->S[i * nk + i]);
    }
    return hn_cholesky(nk, l->S, nk, 1e-28 * largest) == HN_OK ? HN_OK : HN_ERR_SINGULAR;
}

// C Y S^-1 V
static void find_damped(hn_implicit_linear *l) {
    const int nv = l->nv, nk = l->n_kept;
    double *column = l->work[0][0], *moved = l->work[0][1];
    for (int j = 0; j < nv; j++) {
        for (int i = 0; i < nk; i++) {
            column[i] = l->V[l->kept[i] * nv + j];
        }
        hn_cholesky_solve(nk, l->S, nk, column);
        for (int i = 0; i < nv; i++) {
            moved[i] = 0;
            for (int k = 0; k < nk; k++) {
                moved[i] += l->Y[i * l->nc + l->kept[k]] * column[k];
            }
        }
        for (int i = 0; i < nv; i++) {
            l->damped[i * nv + j] = hn_dot(nv, l->C + (size_t)i * (size_t)nv, moved);
        }
    }
}

hn_status hn_implicit_linear_at(hn_implicit_linear *l, double t, const double *q, const double *v,
                                const double *a, const double *lambda) {
    hn_linear_run(l->terms, t, q, v, a, lambda);
    if (!hn_all_finite(l->nv * l->nv, l->M) || !hn_all_finite(l->nv * l->nc, l->J)) {
        return HN_ERR_DIVERGED;
    }
    if (!has_stabiliser(l)) {
        return HN_OK;
    }
    const hn_status status = prepare_stabiliser(l);
    if (status == HN_OK && l->has_damping) {
        find_damped(l);
    }
    return status;
}

// entry of the upper left block without its weights
static double stiffness(const hn_implicit_linear *l, int at) {
    return has_stabiliser(l) && l->has_damping ? l->K[at] - l->damped[at] : l->K[at];
}

static hn_complex reciprocal(double re, double im) {
    const double size = re * re + im * im;
    return (hn_complex){re / size, -im / size};
}

void hn_implicit_linear_matrix(const hn_implicit_linear *l, double s, double *out) {
    const int nv = l->nv, nk = l->n_kept, n = nv + nk;
    const double v_weight = l->form == HN_FORM_INDEX2 ? 1 / s : 0;
    memset(out, 0, (size_t)(n * n) * sizeof *out);
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            const int at = i * nv + j;
            out[i * n + j] = l->M[at] + l->C[at] / s + stiffness(l, at) / (s * s);
        }
    }
    for (int k = 0; k < nk; k++) {
        for (int j = 0; j < nv; j++) {
            const int at = l->kept[k] * nv + j;
            out[j * n + nv + k] = -l->J[at];
            out[(nv + k) * n + j] = l->J[at] + v_weight * l->V[at];
        }
    }
}

static void complex_matrix(hn_implicit_linear *l, double re, double im) {
    const int nv = l->nv, nk = l->n_kept, n = nv + nk;
    const hn_complex one = reciprocal(re, im);
    const hn_complex two = {one.re * one.re - one.im * one.im, 2 * one.re * one.im};
    const double v_weight = l->form == HN_FORM_INDEX2;
    memset(l->matrix, 0, (size_t)(n * n) * sizeof *l->matrix);
    for (int i = 0; i < nv; i++) {
        for (int j = 0; j < nv; j++) {
            const int at = i * nv + j;
            const double k = stiffness(l, at);
            l->matrix[i * n + j] = (hn_complex){l->M[at] + l->C[at] * one.re + k * two.re,
                                                l->C[at] * one.im + k * two.im};
        }
    }
    for (int k = 0; k < nk; k++) {
        for (int j = 0; j < nv; j++) {
            const int at = l->kept[k] * nv + j;
            l->matrix[j * n + nv + k].re = -l->J[at];
            l->matrix[(nv + k) * n + j] =
                (hn_complex){l->J[at] + v_weight * l->V[at] * one.re, v_weight * l->V[at] * one.im};
        }
    }
}

hn_status hn_implicit_linear_factor(hn_implicit_linear *l, int which, double re, double im) {
    const int n = l->nv + l->n_kept;
    l->s[which][0] = re;
    l->s[which][1] = im;
    if (which == 0) {
        hn_implicit_linear_matrix(l, re, l->real);
        return hn_lu_factor(n, l->real, l->pivot[0], l->scale);
    }
    complex_matrix(l, re, im);
    return hn_lu_factor_complex(n, l->matrix, l->pivot[1], l->scale);
}

// vectors in parts: x *= (re, im)
static void multiply(int parts, int n, double *const *x, double re, double im) {
    for (int i = 0; i < n; i++) {
        const double a = x[0][i];
        x[0][i] = re * a;
        if (parts == 2) {
            x[0][i] -= im * x[1][i];
            x[1][i] = im * a + re * x[1][i];
        }
    }
}

// x += sign * y
static void add(int parts, int n, double sign, double *const *y, double *const *x) {
    for (int p = 0; p < parts; p++) {
        hn_axpy(n, sign, y[p], x[p]);
    }
}

static void solve_saddle(hn_implicit_linear *l, int parts, double *const *top,
                         double *const *bottom) {
    const int nv = l->nv, nk = l->n_kept, n = nv + nk;
    double *const real = &l->packed[0].re;
    for (int i = 0; i < n; i++) {
        for (int p = 0; p < parts; p++) {
            real[parts * i + p] = i < nv ? top[p][i] : bottom[p][l->kept[i - nv]];
        }
    }
    if (parts == 1) {
        hn_lu_solve(n, l->real, l->pivot[0], real);
    } else {
        hn_lu_solve_complex(n, l->matrix, l->pivot[1], l->packed);
    }
    for (int p = 0; p < parts; p++) {
        memset(bottom[p], 0, (size_t)l->nc * sizeof *bottom[p]);
        for (int i = 0; i < n; i++) {
            *(i < nv ? &top[p][i] : &bottom[p][l->kept[i - nv]]) = real[parts * i + p];
        }
    }
}

// rows <- S^-1 rows, those that were left out become 0
static void solve_stabiliser(hn_implicit_linear *l, double *rows) {
    double *packed = l->scale;
    for (int k = 0; k < l->n_kept; k++) {
        packed[k] = rows[l->kept[k]];
    }
    hn_cholesky_solve(l->n_kept, l->S, l->n_kept, packed);
    memset(rows, 0, (size_t)l->nc * sizeof *rows);
    for (int k = 0; k < l->n_kept; k++) {
        rows[l->kept[k]] = packed[k];
    }
}

// top += C Y S^-1 e
static void push_stabiliser(hn_implicit_linear *l, const double *e, double *top, double *rows,
                            double *moved) {
    memcpy(rows, e, (size_t)l->nc * sizeof *rows);
    solve_stabiliser(l, rows);
    hn_mat_vec(l->nv, l->nc, l->Y, rows, moved);
    for (int i = 0; i < l->nv; i++) {
        top[i] += hn_dot(l->nv, l->C + (size_t)i * (size_t)l->nv, moved);
    }
}

// -(r2 + C r1) - s M r1 into top; J r1 into along
static void start_right_side(hn_implicit_linear *l, int parts, double *const *r1, double *const *r2,
                             const double *s, double *const *top, double *const *along,
                             double *const *scratch) {
    for (int p = 0; p < parts; p++) {
        hn_mat_vec(l->nv, l->nv, l->M, r1[p], top[p]);
        hn_mat_vec(l->nc, l->nv, l->J, r1[p], along[p]);
    }
    multiply(parts, l->nv, top, s[0], s[1]);
    for (int p = 0; p < parts; p++) {
        if (l->has_damping) {
            hn_mat_vec(l->nv, l->nv, l->C, r1[p], scratch[p]);
            hn_axpy(l->nv, 1, scratch[p], top[p]);
        }
        hn_axpy(l->nv, 1, r2[p], top[p]);
    }
    multiply(parts, l->nv, top, -1, 0);
}

// J's rows as (2) wants them, from r3 and J r1
static void constraint_side(const hn_implicit_linear *l, int parts, const double *s,
                            double *const *r3, double *const *along, double *const *bottom) {
    const hn_complex one = reciprocal(s[0], s[1]);
    for (int p = 0; p < parts; p++) {
        for (int i = 0; i < l->nc; i++) {
            bottom[p][i] = -r3[p][i] - (l->form == HN_FORM_INDEX2 ? along[p][i] : 0);
        }
    }
    if (l->form == HN_FORM_INDEX2) {
        multiply(parts, l->nc, bottom, one.re, one.im);
    }
}

void hn_implicit_linear_solve(hn_implicit_linear *l, hn_parts r) {
    const int nv = l->nv, nc = l->nc, parts = r.n;
    const double *s = l->s[parts - 1];
    const hn_complex one = reciprocal(s[0], s[1]);
    const double two[2] = {one.re * one.re - one.im * one.im, 2 * one.re * one.im};
    double *r1[2] = {0}, *r2[2] = {0}, *r3[2] = {0}, *r4[2] = {0};
    double *top[2], *along[2], *bottom[2], *rows[2], *scratch[2];
    for (int p = 0; p < 2; p++) {
        if (p < parts) {
            r1[p] = r.at[p];
            r2[p] = r1[p] + nv;
            r3[p] = r2[p] + nv;
            r4[p] = r3[p] + nc; // GGL only
        }
        top[p] = l->work[p][0];
        along[p] = l->work[p][1];
        bottom[p] = l->work[p][2];
        rows[p] = l->work[p][3];
        scratch[p] = l->work[p][4];
    }
    start_right_side(l, parts, r1, r2, s, top, along, scratch);
    constraint_side(l, parts, s, r3, along, bottom);
    if (has_stabiliser(l)) { // e = r3' + J r1 - s r3
        multiply(parts, nc, r3, s[0], s[1]);
        add(parts, nc, -1, r3, along);
        add(parts, nc, 1, r4, along);
        for (int p = 0; p < parts && l->has_damping; p++) {
            push_stabiliser(l, along[p], top[p], rows[p], scratch[p]);
        }
    }
    multiply(parts, nv, top, two[0], two[1]);
    solve_saddle(l, parts, top, bottom);
    // l' = s^2 times what was solved for; w = s x + r1 (- Y m)
    const double square[2] = {s[0] * s[0] - s[1] * s[1], 2 * s[0] * s[1]};
    multiply(parts, nc, bottom, square[0], square[1]);
    for (int p = 0; p < parts; p++) {
        memcpy(r2[p], top[p], (size_t)nv * sizeof *top[p]);
        memcpy(r3[p], bottom[p], (size_t)nc * sizeof *bottom[p]);
    }
    multiply(parts, nv, r2, s[0], s[1]);
    add(parts, nv, 1, r1, r2);
    if (has_stabiliser(l)) {
        for (int p = 0; p < parts; p++) {
            hn_mat_vec(nc, nv, l->V, top[p], r4[p]);
            hn_axpy(nc, 1, along[p], r4[p]);
            solve_stabiliser(l, r4[p]);
            hn_mat_vec(nv, nc, l->Y, r4[p], scratch[p]);
            hn_axpy(nv, -1, scratch[p], r2[p]);
            memcpy(rows[p], r4[p], (size_t)nc * sizeof *rows[p]);
        }
        multiply(parts, nc, rows, s[0], s[1]);
        add(parts, nc, -1, rows, r3);
    }
    for (int p = 0; p < parts; p++) {
        memcpy(r1[p], top[p], (size_t)nv * sizeof *top[p]);
    }
}

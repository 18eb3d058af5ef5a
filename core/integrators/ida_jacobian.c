#include "integrators/ida_jacobian.h"

#include "linalg/dense.h"

#include <string.h>

static unsigned terms_of(hn_dae_form form) {
    const unsigned always = HN_LINEAR_M | HN_LINEAR_K | HN_LINEAR_C | HN_LINEAR_J;
    const unsigned gamma = HN_LINEAR_GAMMA_Q | HN_LINEAR_GAMMA_V;
    static const unsigned speeds[HN_FORM_COUNT] = {
        [HN_FORM_INDEX2] = HN_LINEAR_V,
        [HN_FORM_GGL] = HN_LINEAR_V,
        [HN_FORM_STABILISED] = HN_LINEAR_V,
    };
    const int index1 = form == HN_FORM_INDEX1 || form == HN_FORM_STABILISED;
    return always | speeds[form] | (index1 ? gamma : 0);
}

static int is_index1(const hn_ida_problem *p) {
    return p->form == HN_FORM_INDEX1 || p->form == HN_FORM_STABILISED;
}

hn_status hn_ida_jacobian_init(hn_ida_jacobian *j, const hn_ida_problem *problem, hn_arena *arena) {
    const hn_ida_problem *p = problem;
    const size_t nq = (size_t)p->nq, nv = (size_t)p->nv, nc = (size_t)p->nc;
    *j = (hn_ida_jacobian){.problem = p};
    j->unit = hn_arena_doubles(arena, nq + nv);
    j->rate = hn_arena_doubles(arena, nq + nv);
    j->still = hn_arena_doubles(arena, nq + nv);
    j->row_terms = hn_arena_doubles(arena, nc * nv);
    j->row_speeds = hn_arena_doubles(arena, nc * nv);
    j->lambda = hn_arena_doubles(arena, nc);
    if (nq != nv) {
        j->G = hn_arena_doubles(arena, nq * nv);
        j->Gp = hn_arena_doubles(arena, nq * nv);
    }
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }
    j->offset = hn_system_get_info(p->sys).has_time;
    hn_status status = hn_linear_create(p->sys, terms_of(p->form), arena, &j->terms);
    if (status == HN_OK && is_index1(p)) {
        status = hn_linear_create(p->sys, HN_LINEAR_V, arena, &j->turn);
    }
    return status;
}

void hn_ida_jacobian_free(hn_ida_jacobian *j) {
    hn_linear_free(j->terms);
    hn_linear_free(j->turn);
}

// --- blocks ---------------------------------------------------------------------------------------------------

/// A block of A whose first entry is (row, col).
typedef struct block {
    double *at;
    int n; // distance between columns
} block;

static block block_at(double *A, int n, int row, int col) {
    return (block){A + (size_t)col * (size_t)n + row, n};
}

static double *entry(block b, int row, int col) {
    return b.at + (size_t)col * (size_t)b.n + row;
}

// b += s X, X (rows x cols) row-major
static void add_matrix(block b, int rows, int cols, double s, const double *X) {
    for (int i = 0; i < rows; i++) {
        for (int k = 0; k < cols; k++) {
            *entry(b, i, k) += s * X[i * cols + k];
        }
    }
}

// b += s X, where the columns of X go along the speeds and those of the block along q: X G^+
static void add_along_speeds(const hn_ida_jacobian *j, block b, int rows, const double *X) {
    const int nq = j->problem->nq, nv = j->problem->nv;
    if (!j->Gp) {
        add_matrix(b, rows, nv, 1, X);
        return;
    }
    for (int i = 0; i < rows; i++) {
        for (int k = 0; k < nq; k++) {
            double sum = 0;
            for (int s = 0; s < nv; s++) {
                sum += X[i * nv + s] * j->Gp[s * nq + k];
            }
            *entry(b, i, k) += sum;
        }
    }
}

// b -= J' over the kept rows
static void subtract_transpose(block b, const hn_ida_problem *p, const double *J) {
    for (int k = 0; k < p->n_kept; k++) {
        for (int i = 0; i < p->nv; i++) {
            *entry(b, i, k) -= J[p->kept[k] * p->nv + i];
        }
    }
}

static void add_diagonal(block b, int n, double x) {
    for (int i = 0; i < n; i++) {
        *entry(b, i, i) += x;
    }
}

// --- eq. (1) --------------------------------------------------------------------------------------------------

// G, whose columns stand at right angles to each other, and its pseudo-inverse
static void find_G(hn_ida_jacobian *j, const double *q) {
    const int nq = j->problem->nq, nv = j->problem->nv;
    memset(j->unit, 0, (size_t)nv * sizeof *j->unit);
    for (int s = 0; s < nv; s++) {
        j->unit[s] = 1;
        hn_system_kinematics(j->problem->sys, q, j->unit, j->rate);
        j->unit[s] = 0;
        const double square = hn_dot(nq, j->rate, j->rate);
        for (int k = 0; k < nq; k++) {
            j->G[k * nv + s] = j->rate[k];
            j->Gp[s * nq + k] = j->rate[k] / square;
        }
    }
}

// -(G v)_q: G v is a linear function of a quaternion's entries, so unit steps give its derivative exactly
static void subtract_turning(hn_ida_jacobian *j, block b, const double *v) {
    const int nq = j->problem->nq;
    memset(j->unit, 0, (size_t)nq * sizeof *j->unit);
    hn_system_kinematics(j->problem->sys, j->unit, v, j->still);
    for (int k = 0; k < nq; k++) {
        j->unit[k] = 1;
        hn_system_kinematics(j->problem->sys, j->unit, v, j->rate);
        j->unit[k] = 0;
        for (int i = 0; i < nq; i++) {
            *entry(b, i, k) -= j->rate[i] - j->still[i];
        }
    }
}

static void put_kinematics(hn_ida_jacobian *j, double c, const double *y, double *A) {
    const hn_ida_problem *p = j->problem;
    const block by_q = block_at(A, p->n, 0, 0), by_v = block_at(A, p->n, 0, p->nq);
    if (p->form == HN_FORM_GGL) {
        const double *M = hn_linear_get(j->terms, HN_LINEAR_M);
        add_matrix(by_q, p->nv, p->nv, c, M);
        add_matrix(by_v, p->nv, p->nv, -1, M);
        subtract_transpose(block_at(A, p->n, 0, p->nq + p->nv + p->n_kept), p,
                           hn_linear_get(j->terms, HN_LINEAR_J));
        return;
    }
    add_diagonal(by_q, p->nq, c);
    if (!j->G) {
        add_diagonal(by_v, p->nv, -1);
        return;
    }
    find_G(j, y);
    add_matrix(by_v, p->nq, p->nv, -1, j->G);
    subtract_turning(j, by_q, y + p->nq);
}

// --- eq. (2), (3) ---------------------------------------------------------------------------------------------

static void put_dynamics(const hn_ida_jacobian *j, double c, double *A) {
    const hn_ida_problem *p = j->problem;
    const block by_v = block_at(A, p->n, p->nq, p->nq);
    add_along_speeds(j, block_at(A, p->n, p->nq, 0), p->nv, hn_linear_get(j->terms, HN_LINEAR_K));
    add_matrix(by_v, p->nv, p->nv, 1, hn_linear_get(j->terms, HN_LINEAR_C));
    add_matrix(by_v, p->nv, p->nv, c, hn_linear_get(j->terms, HN_LINEAR_M));
    subtract_transpose(block_at(A, p->n, p->nq, p->nq + p->nv), p,
                       hn_linear_get(j->terms, HN_LINEAR_J));
}

static void add_to(double *sum, const hn_ida_jacobian *j, double s, const double *X) {
    hn_axpy(j->problem->nc * j->problem->nv, s, X, sum);
}

static void find_index1_rows(hn_ida_jacobian *j, double t, double c, const double *q,
                             const double *a) {
    const hn_ida_problem *p = j->problem;
    const double *J = hn_linear_get(j->terms, HN_LINEAR_J);
    add_to(j->row_terms, j, 1, hn_linear_get(j->terms, HN_LINEAR_GAMMA_Q));
    add_to(j->row_speeds, j, 1, hn_linear_get(j->terms, HN_LINEAR_GAMMA_V));
    add_to(j->row_speeds, j, c, J);
    hn_linear_run(j->turn, t, q, a, NULL, NULL);
    add_to(j->row_terms, j, 1, hn_linear_get(j->turn, HN_LINEAR_V));
    if (j->offset) {
        hn_linear_run(j->turn, t, q, NULL, NULL, NULL);
        add_to(j->row_terms, j, -1, hn_linear_get(j->turn, HN_LINEAR_V));
    }
    if (p->form == HN_FORM_STABILISED) {
        add_to(j->row_terms, j, 2 * p->alpha, hn_linear_get(j->terms, HN_LINEAR_V));
        add_to(j->row_terms, j, p->beta * p->beta, J);
        add_to(j->row_speeds, j, 2 * p->alpha, J);
    }
}

static void put_rows(const hn_ida_jacobian *j, double *A, int first, const double *by_q,
                     const double *by_v) {
    const hn_ida_problem *p = j->problem;
    for (int k = 0; k < p->n_kept; k++) {
        const size_t row = (size_t)p->kept[k] * (size_t)p->nv;
        if (by_q) {
            add_along_speeds(j, block_at(A, p->n, first + k, 0), 1, by_q + row);
        }
        if (by_v) {
            add_matrix(block_at(A, p->n, first + k, p->nq), 1, p->nv, 1, by_v + row);
        }
    }
}

static void put_constraints(hn_ida_jacobian *j, double t, double c, const double *y,
                            const double *ydot, double *A) {
    const hn_ida_problem *p = j->problem;
    const double *J = hn_linear_get(j->terms, HN_LINEAR_J);
    const int first = p->nq + p->nv;
    if (is_index1(p)) {
        memset(j->row_terms, 0, (size_t)p->nc * (size_t)p->nv * sizeof *j->row_terms);
        memset(j->row_speeds, 0, (size_t)p->nc * (size_t)p->nv * sizeof *j->row_speeds);
        find_index1_rows(j, t, c, y, ydot + p->nq);
        put_rows(j, A, first, j->row_terms, j->row_speeds);
        return;
    }
    if (p->form == HN_FORM_INDEX3) {
        put_rows(j, A, first, J, NULL);
        return;
    }
    put_rows(j, A, first, hn_linear_get(j->terms, HN_LINEAR_V), J);
    if (p->form == HN_FORM_GGL) {
        put_rows(j, A, first + p->n_kept, J, NULL);
    }
}

void hn_ida_jacobian_fill(hn_ida_jacobian *j, double t, double c, const double *y,
                          const double *ydot, double *A) {
    const hn_ida_problem *p = j->problem;
    hn_ida_problem_lambda(p, y, j->lambda);
    hn_linear_run(j->terms, t, y, y + p->nq, ydot + p->nq, j->lambda);
    memset(A, 0, (size_t)p->n * (size_t)p->n * sizeof *A);
    put_kinematics(j, c, y, A);
    put_dynamics(j, c, A);
    put_constraints(j, t, c, y, ydot, A);
    j->count++;
}

double hn_ida_jacobian_ops(const hn_ida_jacobian *j) {
    return hn_linear_ops(j->terms) + (j->turn ? (1 + j->offset) * hn_linear_ops(j->turn) : 0);
}

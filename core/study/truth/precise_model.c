// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth/precise_model.h"

#include "expr/tape_long.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

hn_real *hn_arena_reals(hn_arena *arena, size_t n) {
    return n < SIZE_MAX / sizeof(hn_real) ? hn_arena_get(arena, n * sizeof(hn_real)) : NULL;
}

// ---- creation ----

/// Outputs of a part while it is gathered.
typedef struct gathering {
    hn_precise_part *part;
    hn_ex *outputs;
    int n_outputs;
} gathering;

static void put(gathering *b, hn_ex ex, hn_real *place, hn_real *also) {
    hn_precise_part *p = b->part;
    if (hn_is_zero(ex)) {
        return; // places start as zero
    }
    p->to[p->n] = place;
    p->source[p->n++] = b->n_outputs;
    if (also && also != place) {
        p->to[p->n] = also;
        p->source[p->n++] = b->n_outputs;
    }
    b->outputs[b->n_outputs++] = ex;
}

static void put_list(gathering *b, const hn_ex *list, int n, hn_real *places) {
    for (int i = 0; i < n; i++) {
        put(b, list[i], &places[i], NULL);
    }
}

static void put_mass(gathering *b, const hn_precise_model *m, const hn_ex *M) {
    const int n = m->nv;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            put(b, M[i * n + j], &m->M[i * n + j], &m->M[j * n + i]);
        }
    }
}

static hn_status begin(gathering *b, hn_precise_part *part, size_t most, hn_arena *arena) {
    *b = (gathering){.part = part, .outputs = malloc((most + 1) * sizeof(hn_ex))};
    part->to = hn_arena_get(arena, (most + 1) * sizeof *part->to);
    part->source = hn_arena_ints(arena, most + 1);
    return b->outputs && !hn_arena_failed(arena) ? HN_OK : HN_ERR_MEMORY;
}

/// Compiles the gathered outputs to a tape with the inputs q, v, t.
static hn_status compile(gathering *b, const hn_precise_model *m, hn_arena *arena) {
    const hn_system_exprs ex = hn_system_get_exprs(m->sys);
    const int n_in = m->nq + m->nv + 1;
    hn_precise_part *p = b->part;
    int *symbols = hn_arena_ints(arena, (size_t)n_in);
    if (!symbols) {
        return HN_ERR_MEMORY;
    }

    // inputs and outputs into one tape
    memcpy(symbols, ex.q_symbols, (size_t)m->nq * sizeof *symbols);
    memcpy(symbols + m->nq, ex.v_symbols, (size_t)m->nv * sizeof *symbols);
    symbols[n_in - 1] = ex.t_symbol;

    const hn_status status =
        hn_tape_compile(hn_system_graph(m->sys), b->outputs, b->n_outputs, symbols, n_in, &p->tape);
    if (status != HN_OK) {
        return status;
    }

    // its constants in long double
    p->work = hn_arena_reals(arena, hn_tape_work_size(p->tape));
    if (!p->work) {
        return HN_ERR_MEMORY;
    }
    hn_tape_prepare_long(p->tape, p->work);
    p->slot = hn_tape_output_slots(p->tape);
    return HN_OK;
}

static hn_status create_parts(hn_precise_model *m, hn_arena *arena) {
    const hn_system_exprs ex = hn_system_get_exprs(m->sys);
    const size_t nv = (size_t)m->nv, nc = (size_t)m->nc;
    const size_t most = 2 * nv * nv + nc * nv + nv + 3 * nc + 2;
    const hn_ex *M = hn_system_dense_mass(m->sys, arena);
    const hn_ex *J = hn_system_dense_jacobian(m->sys, arena);
    gathering b;
    if (!M || !J) {
        return HN_ERR_MEMORY;
    }

    // for accelerations: M, f, J, gamma
    hn_status status = begin(&b, &m->dynamics, most, arena);
    if (status == HN_OK) {
        put_mass(&b, m, M);
        put_list(&b, ex.f, m->nv, m->f);
        put_list(&b, J, m->nc * m->nv, m->J);
        put_list(&b, ex.gamma, m->nc, m->gamma);
        status = compile(&b, m, arena);
    }
    free(b.outputs);
    if (status != HN_OK) {
        return status;
    }

    // for projections: M, J, phi, phi_t
    status = begin(&b, &m->closure, most, arena);
    if (status == HN_OK) {
        put_mass(&b, m, M);
        put_list(&b, J, m->nc * m->nv, m->J);
        put_list(&b, ex.phi, m->nc, m->phi);
        put_list(&b, ex.phi_t, m->nc, m->phi_t);
        status = compile(&b, m, arena);
    }
    free(b.outputs);
    if (status != HN_OK) {
        return status;
    }

    // energies
    status = begin(&b, &m->energies, 2, arena);
    if (status == HN_OK) {
        put(&b, ex.kinetic, &m->energy[0], NULL);
        put(&b, ex.potential, &m->energy[1], NULL);
        status = compile(&b, m, arena);
    }
    free(b.outputs);
    return status;
}

/// Finds the place in q of every velocity, and the scale of its coordinate. Quaternions lie between
/// the other entries of q, in the order of their angular velocities.
static void find_positions(hn_precise_model *m) {
    const hn_scene *scene = hn_system_scene(m->sys);
    const int n_user = hn_system_get_info(m->sys).n_user;
    int next = 0;

    for (int i = 0; i < m->nv; i++) {
        const int at = hn_system_position_of(m->sys, i);
        const hn_unit_kind kind =
            i < n_user ? scene->coordinates[hn_system_user_coordinate(m->sys, i)].kind : HN_OTHER;

        // a coordinate with one velocity
        m->floor[i] = kind == HN_LENGTH ? (hn_real)hn_system_length(m->sys) : 1;
        m->position[i] = at >= 0 ? at : next;
        if (at >= 0) {
            next = at + 1;
            continue;
        }

        // a quaternion: three velocities, four entries of q
        m->is_ball[i] = 1;
        m->floor[i + 1] = m->floor[i + 2] = 1;
        m->position[i + 1] = m->position[i + 2] = next;
        next += 4;
        i += 2;
    }
    HN_ASSERT(next == m->nq);
}

hn_status hn_precise_model_create(const hn_system *sys, hn_arena *arena, hn_precise_model **out) {
    const hn_system_info info = hn_system_get_info(sys);
    hn_precise_model *m = hn_arena_get(arena, sizeof *m);
    if (!m) {
        return HN_ERR_MEMORY;
    }
    *m = (hn_precise_model){.sys = sys, .nq = info.nq, .nv = info.nv, .nc = info.nc};
    const size_t nv = (size_t)m->nv, nc = (size_t)m->nc;

    // memory
    m->M = hn_arena_reals(arena, nv * nv);
    m->J = hn_arena_reals(arena, nc * nv);
    m->f = hn_arena_reals(arena, nv);
    m->gamma = hn_arena_reals(arena, nc);
    m->phi = hn_arena_reals(arena, nc);
    m->phi_t = hn_arena_reals(arena, nc);
    m->floor = hn_arena_reals(arena, nv);
    m->position = hn_arena_ints(arena, nv);
    m->is_ball = hn_arena_ints(arena, nv);
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    // places in q, then the tapes
    find_positions(m);
    const hn_status status = create_parts(m, arena);
    if (status != HN_OK) {
        hn_precise_model_free(m);
        return status;
    }
    *out = m;
    return HN_OK;
}

void hn_precise_model_free(hn_precise_model *m) {
    if (m) {
        hn_tape_free(m->dynamics.tape);
        hn_tape_free(m->closure.tape);
        hn_tape_free(m->energies.tape);
        m->dynamics.tape = m->closure.tape = m->energies.tape = NULL;
    }
}

// ---- evaluation ----

static void run(const hn_precise_model *m, hn_precise_part *p, hn_real t, const hn_real *q,
                const hn_real *v) {
    memcpy(p->work, q, (size_t)m->nq * sizeof *q);
    if (v) {
        memcpy(p->work + m->nq, v, (size_t)m->nv * sizeof *v);
    }
    p->work[m->nq + m->nv] = t;
    hn_tape_run_long(p->tape, p->work);
    for (int k = 0; k < p->n; k++) {
        *p->to[k] = p->work[p->slot[p->source[k]]];
    }
}

void hn_precise_model_dynamics(hn_precise_model *m, hn_real t, const hn_real *q, const hn_real *v) {
    run(m, &m->dynamics, t, q, v);
}

void hn_precise_model_closure(hn_precise_model *m, hn_real t, const hn_real *q) {
    run(m, &m->closure, t, q, NULL);
}

void hn_precise_model_energy(hn_precise_model *m, hn_real t, const hn_real *q, const hn_real *v) {
    run(m, &m->energies, t, q, v);
}

// ---- orientations ----

/// 1/2 q o (0, w).
static void ball_rate(const hn_real q[4], const hn_real w[3], hn_real rate[4]) {
    rate[0] = -(q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) / 2;
    rate[1] = (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2;
    rate[2] = (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2;
    rate[3] = (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2;
}

void hn_precise_model_kinematics(const hn_precise_model *m, const hn_real *q, const hn_real *v,
                                 hn_real *qdot) {
    for (int i = 0; i < m->nv; i++) {
        if (m->is_ball[i]) {
            ball_rate(q + m->position[i], v + i, qdot + m->position[i]);
            i += 2;
        } else {
            qdot[m->position[i]] = v[i];
        }
    }
}

void hn_precise_model_nudge(const hn_precise_model *m, hn_real *q, const hn_real *delta) {
    for (int i = 0; i < m->nv; i++) {
        if (m->is_ball[i]) {
            hn_real rate[4];
            ball_rate(q + m->position[i], delta + i, rate);
            for (int k = 0; k < 4; k++) {
                q[m->position[i] + k] += rate[k];
            }
            i += 2;
        } else {
            q[m->position[i]] += delta[i];
        }
    }
    hn_precise_model_normalise(m, q);
}

void hn_precise_model_normalise(const hn_precise_model *m, hn_real *q) {
    for (int i = 0; i < m->nv; i++) {
        if (m->is_ball[i]) {
            hn_real *x = q + m->position[i];
            const hn_real length = sqrtl(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
            for (int k = 0; k < 4 && length > 0; k++) {
                x[k] /= length;
            }
            i += 2;
        }
    }
}

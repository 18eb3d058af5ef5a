// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/reactions/reactions_state.h"

#include <string.h>

void hn_reaction_add_cross(double out[3], double k, const double a[3], const double b[3]) {
    double c[3];
    hn_num3_cross(a, b, c);
    for (int i = 0; i < 3; i++) {
        out[i] += k * c[i];
    }
}

void hn_reaction_add_scaled(double out[3], double k, const double a[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] += k * a[i];
    }
}

void hn_reaction_apply(const double m[3][3], const double v[3], double out[3]) {
    const double c[3] = {hn_num3_dot(m[0], v), hn_num3_dot(m[1], v), hn_num3_dot(m[2], v)};
    memcpy(out, c, sizeof c);
}

void hn_reaction_apply_transposed(const double m[3][3], const double v[3], double out[3]) {
    const double c[3] = {m[0][0] * v[0] + m[1][0] * v[1] + m[2][0] * v[2],
                         m[0][1] * v[0] + m[1][1] * v[1] + m[2][1] * v[2],
                         m[0][2] * v[0] + m[1][2] * v[1] + m[2][2] * v[2]};
    memcpy(out, c, sizeof c);
}

double hn_reaction_value(const hn_reactions *r, int k) {
    return r->in.x[r->in.slots[k]];
}

void hn_reaction_values3(const hn_reactions *r, int k, double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = hn_reaction_value(r, k + i);
    }
}

void hn_reaction_to_world(const hn_reactions *r, int body, const double v[3], double out[3]) {
    if (body == HN_GROUND) {
        memcpy(out, v, 3 * sizeof *out);
    } else {
        hn_reaction_apply((const double(*)[3])r->bodies[body].R, v, out);
    }
}

void hn_reaction_place_of(const hn_reactions *r, int body, const hn_quantity *at, double out[3]) {
    double arm[3];
    for (int i = 0; i < 3; i++) {
        arm[i] = at[i].value - (body == HN_GROUND ? 0 : r->scene->bodies[body].com[i].value);
    }
    hn_reaction_to_world(r, body, arm, out);
    for (int i = 0; i < 3 && body != HN_GROUND; i++) {
        out[i] += r->bodies[body].x[i];
    }
}

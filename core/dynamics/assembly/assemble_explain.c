// SPDX-License-Identifier: GPL-3.0-or-later

#include "dynamics/assembly/assemble_explain.h"

#include "dynamics/assembly/assemble_pose.h"
#include "linalg/dense.h"
#include "linalg/small3.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const double MANY_TURNS = 1e6; // [rad] up to here an angle has digits enough to close a loop
static const double PARALLEL = 1e-9;  // sine of the angle between axes that count as parallel

/// One body of the ring with the joints through which the ring enters and leaves it.
typedef struct ring_part {
    int body;
    int joint_in, joint_out;
} ring_part;

// ---- the ring of a loop ----

static int tree_parent(const hn_assembler *s, int body) {
    const hn_joint *joint = &s->scene->joints[hn_system_tree_joint(s->sys, body)];
    return joint->child == body ? joint->parent : joint->child;
}

static int depth_of(const hn_assembler *s, int body) {
    int depth = 0;
    for (; body != HN_GROUND; body = tree_parent(s, body)) {
        depth++;
    }
    return depth;
}

/// Walks from both bodies of the cut joint up to their common ancestor. Returns the number of
/// parts; `parts` holds n_bodies + 1.
static int find_ring(const hn_assembler *s, int cut, ring_part *parts) {
    int a = s->scene->joints[cut].child, b = s->scene->joints[cut].parent, n = 0, n_back = 0;
    int depth_a = depth_of(s, a), depth_b = depth_of(s, b), in = cut, out = cut;

    // up from both ends, the deeper one first
    ring_part *back = parts + s->scene->n_bodies + 1; // the parent's side, to be turned round
    while (a != b) {
        if (depth_a >= depth_b) {
            int up = hn_system_tree_joint(s->sys, a);
            parts[n++] = (ring_part){a, in, up};
            in = up;
            a = tree_parent(s, a);
            depth_a--;
        } else {
            int up = hn_system_tree_joint(s->sys, b);
            back[n_back++] = (ring_part){b, up, out};
            out = up;
            b = tree_parent(s, b);
            depth_b--;
        }
    }

    // the common ancestor, then down the parent's side
    parts[n++] = (ring_part){a, in, out};
    while (n_back > 0) {
        parts[n++] = back[--n_back];
    }
    return n;
}

/// The joint cannot move: a fixed one, or one with all its degrees of freedom pinned.
static int is_pinned(const hn_assembler *s, int joint) {
    const hn_joint *j = &s->scene->joints[joint];
    if (j->type == HN_JOINT_FIXED) {
        return 1;
    }
    int pinned = !hn_system_joint_is_cut(s->sys, joint);
    for (int k = 0; k < j->n_coordinates; k++) {
        pinned &= s->scene->coordinates[j->coordinate + k].q0_pinned;
    }
    return pinned;
}

static const char *body_name(const hn_assembler *s, int body) {
    return body == HN_GROUND ? "ground" : s->scene->bodies[body].name;
}

// ---- sides of the polygon ----

typedef struct side {
    double length;
    int n_bodies, body; ///< how many bodies it is made of; the first
    char name[96];
} side;

/// 1 if every joint of the ring that may move is a revolute and all their axes are parallel in the
/// world.
static int is_polygon(const hn_assembler *s, const ring_part *parts, int n) {
    double first[3] = {0};
    int have = 0;
    for (int k = 0; k < n; k++) {
        // a joint that may move must be a revolute
        const hn_joint *joint = &s->scene->joints[parts[k].joint_in];
        if (is_pinned(s, parts[k].joint_in)) {
            continue;
        }
        if (joint->type != HN_JOINT_REVOLUTE) {
            return 0;
        }

        // and its axis parallel to the first one's
        double axis[3];
        hn_body_pose at = hn_assemble_body_pose(s, parts[k].body);
        hn_num3_apply(at.R, joint->child == parts[k].body ? joint->child_axis : joint->parent_axis,
                      axis);
        if (!have) {
            memcpy(first, axis, sizeof first);
            have = 1;
        }
        double cosine = hn_dot(3, first, axis);
        if (1 - cosine * cosine > PARALLEL) {
            return 0;
        }
    }
    return have;
}

static void append_name(side *to, const char *name) {
    size_t used = strlen(to->name);
    (void)snprintf(to->name + used, sizeof to->name - used, "%s%s", used ? "+" : "", name);
}

/// Distance across the axis between the joints at which a run of parts begins and ends.
static double side_length(const hn_assembler *s, const ring_part *first, const ring_part *last) {
    double from[3], to[3], axis[3];
    hn_assemble_joint_position(s, first->joint_in, first->body, from);
    hn_assemble_joint_position(s, last->joint_out, last->body, to);
    const hn_joint *joint = &s->scene->joints[first->joint_in];
    hn_body_pose at = hn_assemble_body_pose(s, first->body);
    hn_num3_apply(at.R, joint->child == first->body ? joint->child_axis : joint->parent_axis, axis);
    double d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    hn_axpy(3, -hn_dot(3, d, axis), axis, d);
    return hn_norm2(3, d);
}

/// Joins parts over pinned joints into sides; returns how many there are.
static int find_sides(const hn_assembler *s, const ring_part *parts, int n, side *sides) {
    int first = 0, count = 0;

    // begin at a joint that may turn
    while (is_pinned(s, parts[first].joint_in)) {
        first++; // a polygon has a joint that may turn
    }

    // bodies over pinned joints are one side
    for (int k = 0; k < n;) {
        side *now = &sides[count++];
        int begin = (first + k) % n, end = begin;
        *now = (side){.body = parts[begin].body};
        for (;;) {
            end = (first + k) % n;
            append_name(now, body_name(s, parts[end].body));
            now->n_bodies++;
            k++;
            if (k == n || !is_pinned(s, parts[end].joint_out)) {
                break;
            }
        }
        now->length = side_length(s, &parts[begin], &parts[end]);
    }
    return count;
}

/// A side is not made longer by more than this many times its length.
static const double MOST_LONGER = 2;

/// The smallest changes that would close the polygon: one side longer or shorter by the missing
/// length, where that is a change of this mechanism and not another one. A side of several bodies
/// has no length to set.
static void list_remedies(const side *sides, int n, int longest, double missing, char *text,
                          size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < n && used + 1 < size; k++) {
        if (sides[k].n_bodies > 1 || missing > MOST_LONGER * sides[k].length) {
            continue;
        }
        double to = sides[k].length + (k == longest ? -missing : missing);
        int wrote =
            snprintf(text + used, size - used, "%s%s %s than %.6g m", used ? " or " : "make ",
                     sides[k].name, k == longest ? "shorter" : "longer", to);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}

/// "coupler + rocker reach 3.8 m, 4.2 m are needed": adds to `text`, and the remedy to `hint`.
/// Nothing if the polygon could close.
static void explain_polygon(const hn_assembler *s, const side *sides, int n, char *text,
                            size_t size, char *hint, size_t hint_size) {
    int longest = 0;
    double sum = 0;
    for (int k = 0; k < n; k++) {
        sum += sides[k].length;
        longest = sides[k].length > sides[longest].length ? k : longest;
    }
    double others = sum - sides[longest].length, missing = sides[longest].length - others;
    if (missing <= 1e-9 * s->length) {
        return;
    }
    (void)snprintf(
        text, size,
        ": the side %s is %.6g m long, the others together %.6g m, so %.6g m are missing",
        sides[longest].name, sides[longest].length, others, missing);
    list_remedies(sides, n, longest, missing, hint, hint_size);
}

static void explain_ring(hn_assembler *s, int loop, char *text, size_t size, char *hint,
                         size_t hint_size) {
    int cut = s->scene->is_lagrangian ? -1 : hn_system_loop_joint(s->sys, loop);
    if (cut < 0) {
        return;
    }
    size_t room = (size_t)s->scene->n_bodies + 1;
    ring_part *parts = hn_arena_get(s->arena, 2 * room * sizeof *parts);
    side *sides = hn_arena_get(s->arena, room * sizeof *sides);
    if (!parts || !sides) {
        return;
    }
    int n = find_ring(s, cut, parts);
    if (is_polygon(s, parts, n)) {
        explain_polygon(s, sides, find_sides(s, parts, n, sides), text, size, hint, hint_size);
    }
}

// ---- the message ----

/// Names and values of the pins that hold coordinates of this loop.
static void list_pins(hn_assembler *s, int loop, char *text, size_t size) {
    double *row = hn_arena_doubles(s->arena, (size_t)s->n);
    int *moves = hn_arena_ints(s->arena, (size_t)s->n);
    size_t used = 0;
    text[0] = '\0';
    if (!row || !moves) {
        return;
    }

    // coordinates that move this loop
    for (int i = 0; i < s->nc; i++) {
        if (hn_system_row_loop(s->sys, i) == loop) {
            hn_assemble_user_row(s, i, row);
            for (int k = 0; k < s->n; k++) {
                moves[k] |= row[k] != 0;
            }
        }
    }

    // the pinned ones of them
    for (int k = 0; k < s->n && used + 1 < size; k++) {
        const hn_coordinate *c = &s->scene->coordinates[hn_system_user_coordinate(s->sys, k)];
        if (moves[k] && c->q0_pinned) {
            int wrote =
                snprintf(text + used, size - used, "%s%s = %.6g", used ? ", " : "", c->name, c->q0);
            used += wrote > 0 ? (size_t)wrote : 0;
        }
    }
}

static const char *first_pin_pointer(const hn_assembler *s) {
    for (int k = 0; k < s->n; k++) {
        const hn_coordinate *c = &s->scene->coordinates[hn_system_user_coordinate(s->sys, k)];
        if (c->q0_pinned) {
            return c->q0_pointer;
        }
    }
    return NULL;
}

static bool loop_has_lengths(const hn_assembler *s, int loop) {
    for (int i = 0; i < s->nc; i++) {
        if (hn_system_row_loop(s->sys, i) == loop && hn_system_row_is_length(s->sys, i)) {
            return true;
        }
    }
    return false;
}

/// Tells of a starting angle so large that the gap is the rounding of its double; false where the
/// gap is more than that. An angle is exact to half of its DBL_EPSILON, at an arm as long as the
/// mechanism, and some of them add up around a loop.
static bool tell_digits(hn_assembler *s, int loop, double gap) {
    const hn_coordinate *largest = NULL;
    for (int k = 0; k < s->n; k++) {
        const hn_coordinate *c = &s->scene->coordinates[hn_system_user_coordinate(s->sys, k)];
        if (c->kind == HN_ANGLE && (!largest || fabs(c->q0) > fabs(largest->q0))) {
            largest = c;
        }
    }

    // the distance of two doubles of that size
    const double apart = largest ? DBL_EPSILON * fabs(largest->q0) : 0;
    if (!largest || gap > apart * fmax(1, hn_system_length(s->sys)) ||
        fabs(largest->q0) <= MANY_TURNS) {
        return false;
    }
    hn_diags_add(s->diags, HN_ERR_UNREACHABLE, largest->q0_pointer,
                 "subtract whole turns of 2 pi: up to 1e6 rad an angle has enough digits",
                 "%s = %.6g rad is too large: numbers of this size are %.2g rad apart, so loop %s "
                 "keeps a gap of %.6g%s",
                 largest->name, largest->q0, apart, hn_system_loop_name(s->sys, loop), gap,
                 loop_has_lengths(s, loop) ? " m" : "");
    return true;
}

void hn_assemble_explain(hn_assembler *s, int loop) {
    if (tell_digits(s, loop, hn_assemble_gap(s, loop))) {
        return;
    }

    // what is pinned, and what lengths are missing
    char pins[128], reason[256] = "", hint[HN_DIAG_HINT] = "";
    list_pins(s, loop, pins, sizeof pins);
    explain_ring(s, loop, reason, sizeof reason, hint, sizeof hint);

    // what to try
    size_t used = strlen(hint);
    const char * or = used ? ", or " : "";
    if (pins[0]) {
        (void)snprintf(hint + used, sizeof hint - used, "%schange what is held at the start (%s)",
                       or, pins);
    } else if (!used) {
        (void)snprintf(hint, sizeof hint, "start from another guess, or change a length");
    }

    // one sentence for each way of staying open
    const char *with = pins[0] ? " with " : "", *held = pins[0] ? " held" : "",
               *pointer = first_pin_pointer(s);
    double gap = hn_assemble_gap(s, loop);
    if (hn_assemble_flipped(s) == loop) {
        hn_diags_add(s->diags, HN_ERR_UNREACHABLE, pointer,
                     "check the axes of its joints, or start from another guess",
                     "loop %s was only found closed with the axes of its two halves in opposite "
                     "directions%s%s%s",
                     hn_system_loop_name(s->sys, loop), with, pins, held);
        return;
    }

    if (s->scene->is_lagrangian) {
        hn_diags_add(
            s->diags, HN_ERR_UNREACHABLE, pointer, hint,
            "the constraints cannot all be met: '%s' is off by %.6g, all of them by %.6g%s%s%s",
            hn_system_loop_name(s->sys, loop), gap, hn_assemble_gap(s, -1), with, pins, held);
        return;
    }

    // the missing length is the gap that is left
    if (reason[0]) {
        hn_diags_add(s->diags, HN_ERR_UNREACHABLE, pointer, hint,
                     "loop %s cannot be closed%s%s%s%s", hn_system_loop_name(s->sys, loop), reason,
                     with, pins, held);
        return;
    }
    hn_diags_add(s->diags, HN_ERR_UNREACHABLE, pointer, hint,
                 "loop %s cannot be closed: a gap of %.6g%s is left%s%s%s",
                 hn_system_loop_name(s->sys, loop), gap, loop_has_lengths(s, loop) ? " m" : "",
                 with, pins, held);
}

// Why a loop stays open. Beside the gap and the pins: where the joints of the loop that may turn
// are parallel revolutes, the loop is a polygon. Bodies between two turning joints form one side
// (pinned joints make them rigid), and it closes if and only if no side is longer than all the
// others together.

#include "dynamics/assembly/assemble_internal.h"
#include "dynamics/compile/quaternion.h"
#include "dynamics/compile/tree.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PARALLEL = 1e-9; // sine of the angle between axes that count as parallel

typedef struct pose {
    double R[9]; // body to world
    double p[3]; // world position of the body's origin
} pose;

/// One body of the ring with the joints through which the ring enters and leaves it.
typedef struct ring_part {
    int body;
    int joint_in, joint_out;
} ring_part;

// ---- poses of bodies, straight from the scene ----

static void rotate(const double R[9], const double x[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
    }
}

static void multiply(const double A[9], const double B[9], double out[9]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
        }
    }
}

static void transpose(const double A[9], double out[9]) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[3 * i + j] = A[3 * j + i];
        }
    }
}

/// Joint frame in body axes: columns ref, axis x ref, axis.
static void joint_frame(const double axis[3], const double ref[3], double out[9]) {
    const double side[3] = {axis[1] * ref[2] - axis[2] * ref[1],
                            axis[2] * ref[0] - axis[0] * ref[2],
                            axis[0] * ref[1] - axis[1] * ref[0]};
    for (int i = 0; i < 3; i++) {
        out[3 * i] = ref[i];
        out[3 * i + 1] = side[i];
        out[3 * i + 2] = axis[i];
    }
}

static void place(const hn_quantity at[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = at[i].value;
    }
}

/// Turn by one primitive of a joint at its coordinates x, in the joint's axes, and the way it
/// moves.
static void primitive_motion(const hn_primitive *primitive, const double *x, double turn[9],
                             double way[3]) {
    const int i = (primitive->along + 1) % 3, j = (primitive->along + 2) % 3;
    if (primitive->type == HN_JOINT_REVOLUTE) {
        turn[4 * i] = turn[4 * j] = cos(x[0]);
        turn[3 * j + i] = sin(x[0]);
        turn[3 * i + j] = -turn[3 * j + i];
    } else if (primitive->type == HN_JOINT_PRISMATIC) {
        way[primitive->along] = x[0];
    } else if (primitive->type == HN_JOINT_SPHERICAL) {
        for (int k = 0; k < 3; k++) { // column k: the unit vector k turned
            double q[4], back[4], e[4] = {0}, out[4];
            hn_quat_exp(x, q);
            hn_quat_exp((double[3]){-x[0], -x[1], -x[2]}, back);
            e[k + 1] = 1;
            hn_quat_mul(q, e, out);
            hn_quat_mul(out, back, out);
            for (int r = 0; r < 3; r++) {
                turn[3 * r + k] = out[r + 1];
            }
        }
    }
}

/// Rotation and shift from the joint's child to its parent at coordinate values x: p_parent = R
/// p_child + shift.
static void joint_transform(const hn_joint *joint, const double *x, pose *out) {
    double B[9], C[9], Ct[9], so_far[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, half[9], slid[3] = {0};
    const hn_primitive *chain;
    const int n = hn_joint_primitives(joint->type, &chain);
    joint_frame(joint->parent_axis, joint->parent_ref, B);
    joint_frame(joint->child_axis, joint->child_ref, C);
    for (int k = 0; k < n; k++) {
        double turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, way[3] = {0, 0, 0}, gone[3];
        primitive_motion(&chain[k], x + chain[k].part, turn, way);
        rotate(so_far, way, gone);
        hn_axpy(3, 1, gone, slid);
        multiply(so_far, turn, half);
        memcpy(so_far, half, sizeof half);
    }
    transpose(C, Ct);
    multiply(B, so_far, half);
    multiply(half, Ct, out->R);

    double at_parent[3], at_child[3], arm[3], gone[3];
    place(joint->parent_at, at_parent);
    place(joint->child_at, at_child);
    rotate(out->R, at_child, arm);
    rotate(B, slid, gone);
    for (int i = 0; i < 3; i++) {
        out->p[i] = at_parent[i] + gone[i] - arm[i];
    }
}

static void coordinate_values(const hn_assembler *s, const hn_joint *joint, double x[6]) {
    for (int k = 0; k < s->n; k++) {
        const int part = hn_system_user_coordinate(s->sys, k) - joint->coordinate;
        if (joint->coordinate >= 0 && part >= 0 && part < joint->n_coordinates) {
            x[part] = s->x[k];
        }
    }
}

/// Pose of a body by its tree joints down to the ground. The tree is shallow and this runs once, on
/// failure.
static pose find_pose(const hn_assembler *s, int body) {
    pose at = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    while (body != HN_GROUND) {
        const hn_joint *joint = &s->scene->joints[hn_system_tree_joint(s->sys, body)];
        pose step, next;
        double x[6] = {0};
        coordinate_values(s, joint, x);
        joint_transform(joint, x, &step);
        if (joint->child != body) { // the tree runs through this joint backwards
            pose inverse;
            transpose(step.R, inverse.R);
            rotate(inverse.R, step.p, inverse.p);
            for (int i = 0; i < 3; i++) {
                inverse.p[i] = -inverse.p[i];
            }
            step = inverse;
        }
        multiply(step.R, at.R, next.R);
        rotate(step.R, at.p, next.p);
        for (int i = 0; i < 3; i++) {
            next.p[i] += step.p[i];
        }
        at = next;
        body = joint->child == body ? joint->parent : joint->child;
    }
    return at;
}

/// World position of a joint as seen from one of its two bodies.
static void joint_position(const hn_assembler *s, int joint_index, int body, double out[3]) {
    const hn_joint *joint = &s->scene->joints[joint_index];
    double local[3];
    place(joint->parent == body ? joint->parent_at : joint->child_at, local);
    pose at = find_pose(s, body);
    rotate(at.R, local, out);
    for (int i = 0; i < 3; i++) {
        out[i] += at.p[i];
    }
}

// ---- loops closed the wrong way round ----

static void world_direction(const hn_assembler *s, int body, const double v[3], double out[3]) {
    const pose at = find_pose(s, body);
    rotate(at.R, v, out);
}

/// Whether directions of the two halves that should agree are opposed. Joints that leave an
/// orientation free have none.
static int is_opposed(const hn_assembler *s, const hn_joint *joint) {
    double a[3], b[3];
    if (joint->type == HN_JOINT_SPHERICAL || joint->type == HN_JOINT_UNIVERSAL) {
        return 0;
    }
    world_direction(s, joint->parent, joint->parent_axis, a);
    world_direction(s, joint->child, joint->child_axis, b);
    int opposed = hn_dot(3, a, b) < 0;
    if (joint->type == HN_JOINT_PRISMATIC || joint->type == HN_JOINT_FIXED) {
        world_direction(s, joint->parent, joint->parent_ref, a);
        world_direction(s, joint->child, joint->child_ref, b);
        opposed |= hn_dot(3, a, b) < 0;
    }
    return opposed;
}

int hn_assemble_flipped(const hn_assembler *s) {
    for (int i = 0; i < s->nc && !s->scene->is_lagrangian; i++) {
        const int loop = hn_system_row_loop(s->sys, i), joint = hn_system_loop_joint(s->sys, loop);
        if (joint < 0 || hn_system_row_is_length(s->sys, i) ||
            (i > 0 && hn_system_row_loop(s->sys, i - 1) == loop &&
             !hn_system_row_is_length(s->sys, i - 1))) {
            continue; // once per loop, at its first row that is an angle
        }
        if (is_opposed(s, &s->scene->joints[joint])) {
            return loop;
        }
    }
    return -1;
}

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
    parts[n++] = (ring_part){a, in, out};
    while (n_back > 0) {
        parts[n++] = back[--n_back];
    }
    return n;
}

/// The joint cannot move: a fixed one, or one with all its freedoms pinned.
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
        const hn_joint *joint = &s->scene->joints[parts[k].joint_in];
        if (is_pinned(s, parts[k].joint_in)) {
            continue;
        }
        if (joint->type != HN_JOINT_REVOLUTE) {
            return 0;
        }
        double axis[3];
        pose at = find_pose(s, parts[k].body);
        rotate(at.R, joint->child == parts[k].body ? joint->child_axis : joint->parent_axis, axis);
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
    joint_position(s, first->joint_in, first->body, from);
    joint_position(s, last->joint_out, last->body, to);
    const hn_joint *joint = &s->scene->joints[first->joint_in];
    pose at = find_pose(s, first->body);
    rotate(at.R, joint->child == first->body ? joint->child_axis : joint->parent_axis, axis);
    double d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    hn_axpy(3, -hn_dot(3, d, axis), axis, d);
    return hn_norm2(3, d);
}

/// Joins parts over pinned joints into sides; returns how many there are.
static int find_sides(const hn_assembler *s, const ring_part *parts, int n, side *sides) {
    int first = 0, count = 0;
    while (is_pinned(s, parts[first].joint_in)) {
        first++; // a polygon has a joint that may turn
    }
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

/// The smallest changes that mend it: one side longer or shorter by what is missing. A side of
/// several bodies has no length to set.
static void list_remedies(const side *sides, int n, int longest, double missing, char *text,
                          size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < n && used + 1 < size; k++) {
        if (sides[k].n_bodies > 1) {
            continue;
        }
        double to = sides[k].length + (k == longest ? -missing : missing);
        int wrote = snprintf(text + used, size - used, "%s%s %.6g m", used ? " or " : "make ",
                             sides[k].name, to);
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
    (void)snprintf(text, size,
                   "; %s spans %.6g m, the other sides together reach %.6g m: %.6g m are missing",
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
    for (int i = 0; i < s->nc; i++) {
        if (hn_system_row_loop(s->sys, i) == loop) {
            hn_assemble_user_row(s, i, row);
            for (int k = 0; k < s->n; k++) {
                moves[k] |= row[k] != 0;
            }
        }
    }
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

static int loop_has_lengths(const hn_assembler *s, int loop) {
    for (int i = 0; i < s->nc; i++) {
        if (hn_system_row_loop(s->sys, i) == loop && hn_system_row_is_length(s->sys, i)) {
            return 1;
        }
    }
    return 0;
}

void hn_assemble_explain(hn_assembler *s, int loop) {
    char pins[128], reason[256] = "", hint[HN_DIAG_HINT] = "";
    list_pins(s, loop, pins, sizeof pins);
    explain_ring(s, loop, reason, sizeof reason, hint, sizeof hint);
    size_t used = strlen(hint);
    const char *other =
        pins[0] ? "release a pin" : (used ? "" : "start from another guess, or change a length");
    (void)snprintf(hint + used, sizeof hint - used, "%s%s", used && other[0] ? ", or " : "", other);
    const char *with = pins[0] ? " with " : "", *held = pins[0] ? " held" : "",
               *pointer = first_pin_pointer(s);
    double gap = hn_assemble_gap(s, loop);
    if (hn_assemble_flipped(s) == loop) {
        hn_diags_add(s->diags, HN_ERR_UNREACHABLE, pointer,
                     "check the axes of its joints, or start from another guess",
                     "loop %s was only found closed with the axes of its halves opposed%s%s%s",
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
    hn_diags_add(s->diags, HN_ERR_UNREACHABLE, pointer, hint,
                 "loop %s cannot be closed: a gap of %.6g%s is left%s%s%s%s",
                 hn_system_loop_name(s->sys, loop), gap, loop_has_lengths(s, loop) ? " m" : "",
                 with, pins, held, reason);
}

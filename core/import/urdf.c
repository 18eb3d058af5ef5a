// SPDX-License-Identifier: GPL-3.0-or-later
// URDF: links and joints by name, a tree whose root is fixed to the ground. Semantics after the ROS
// wiki (urdf/XML).
#include "import/urdf.h"

#include "base/suggest.h"
#include "import/xml.h"

#include "linalg/small3.h"

#include <math.h>
#include <string.h>

#define USED HN_IMPORT_OUTCOME_COUNT
#define END \
    { NULL, USED, NULL }

static const hn_im_rule ROBOT[] = {{"name version", USED, NULL}, END};
static const hn_im_rule LINK[] = {
    {"name", USED, NULL}, {"type", HN_IMPORT_IGNORED, "says nothing about motion"}, END};
static const hn_im_rule INERTIAL[] = {END};
static const hn_im_rule ORIGIN[] = {{"xyz rpy", USED, NULL}, END};
static const hn_im_rule MASS[] = {{"value", USED, NULL}, END};
static const hn_im_rule INERTIA[] = {{"ixx iyy izz ixy ixz iyz", USED, NULL}, END};
static const hn_im_rule JOINT[] = {{"name type", USED, NULL}, END};
static const hn_im_rule SIDE[] = {{"link", USED, NULL}, END};
static const hn_im_rule AXIS[] = {{"xyz", USED, NULL}, END};
static const hn_im_rule LIMIT[] = {
    {"lower upper", USED, NULL},
    {"effort velocity", HN_IMPORT_IGNORED, "limits of a drive; there is none in the file"},
    END};
static const hn_im_rule DYNAMICS[] = {
    {"damping", USED, NULL},
    {"friction", HN_IMPORT_REFUSED, "dry friction is not in the scene"},
    END};
static const hn_im_rule MIMIC[] = {{"joint multiplier offset", USED, NULL}, END};

typedef struct urdf {
    hn_build *b;
    const xmlNode *root;
    int n_links, n_joints;
    const xmlNode **links, **joints;
    int *parent, *child; ///< links of a joint
    int *carrier;        ///< joint that carries a link, -1: none
    int *body;           ///< body of a link, -1: not made yet
} urdf;

static const char *need(urdf *u, const xmlNode *node, const char *attribute) {
    const char *text = hn_im_attr(u->b, node, attribute);
    if (!text || !*text) {
        hn_im_fault(u->b, node, NULL, NULL, "the attribute '%s' is missing", attribute);
        return NULL;
    }
    return text;
}

/// Fixed axes: about x, then y, then z of the frame around.
static bool read_origin(urdf *u, const xmlNode *around, hn_im_frame *out) {
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const xmlNode *origin = hn_im_child(around, "origin");
    double rpy[3] = {0, 0, 0}, turn[3][3];
    *out = hn_im_frame_unit();
    if (!origin) {
        return true;
    }
    hn_im_check_attributes(u->b, origin, ORIGIN);
    if (hn_im_vector(u->b, origin, "xyz", 3, out->p) < 0 ||
        hn_im_vector(u->b, origin, "rpy", 3, rpy) < 0) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        hn_im_rotation(axes[k], rpy[k], turn);
        hn_num3_mul(turn, out->R, out->R);
    }
    hn_im_snap(out->R);
    return true;
}

/// Names children of an element that are not among `known`.
static void name_others(urdf *u, const xmlNode *node, const char *known) {
    for (const xmlNode *c = hn_im_first(node); c; c = hn_im_next(c)) {
        const char *name = (const char *)c->name;
        if (hn_im_lists("visual collision material verbose", name)) {
            hn_im_skip(u->b, HN_IMPORT_IGNORED, c,
                       strcmp(name, "collision") == 0 ? "contacts are not in the scene"
                                                      : "affects the appearance only");
        } else if (hn_im_lists("calibration safety_controller transmission sensor ros2_control",
                               name)) {
            hn_im_skip(u->b, HN_IMPORT_IGNORED, c, "for the robot's own software");
        } else if (!hn_im_lists(known, name)) {
            hn_im_skip(u->b, HN_IMPORT_REFUSED, c, "not part of URDF's mechanics: not read");
        }
    }
}

// ---- links ----

static bool read_inertia(urdf *u, const xmlNode *node, double I[6]) {
    static const char *const names[] = {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"};
    hn_im_check_attributes(u->b, node, INERTIA);
    for (int k = 0; k < 6; k++) {
        if ((k < 3 && !need(u, node, names[k])) ||
            hn_im_vector(u->b, node, names[k], 1, &I[k]) < 0) {
            return false;
        }
    }
    return true;
}

static bool read_mass(urdf *u, const xmlNode *link, hn_im_mass *out) {
    const xmlNode *inertial = hn_im_child(link, "inertial");
    hn_im_mass own = {.m = 0};
    hn_im_frame at;
    *out = own;
    if (!inertial) {
        return true;
    }

    // its mass, and its inertia if it has one
    const xmlNode *mass = hn_im_child(inertial, "mass"),
                  *inertia = hn_im_child(inertial, "inertia");
    hn_im_check_attributes(u->b, inertial, INERTIAL);
    name_others(u, inertial, "origin mass inertia");
    if (!mass || !need(u, mass, "value")) {
        return mass ? 0 : hn_im_fault(u->b, inertial, NULL, NULL, "an 'inertial' needs its 'mass'");
    }
    hn_im_check_attributes(u->b, mass, MASS);
    if (!read_origin(u, inertial, &at) || hn_im_vector(u->b, mass, "value", 1, &own.m) < 0 ||
        (inertia && !read_inertia(u, inertia, own.I))) {
        return false;
    }
    if (own.m < 0) {
        return hn_im_fault(u->b, mass, "value", NULL, "a mass of %g kg is negative", own.m);
    }
    *out = hn_im_mass_moved(&own, &at);
    return true;
}

static bool add_link(urdf *u, int link, const hn_im_frame *world) {
    const xmlNode *node = u->links[link];
    hn_im_mass mass;
    hn_im_check_attributes(u->b, node, LINK);
    name_others(u, node, "inertial");
    if (!read_mass(u, node, &mass)) {
        return false;
    }
    int body = hn_im_add_body(u->b, node, need(u, node, "name"), world);
    if (body < 0) {
        return false;
    }
    u->b->bodies[body].mass = mass;
    u->b->bodies[body].has_mass = mass.m > 0;
    u->body[link] = body;
    return true;
}

// ---- joints ----

static const struct {
    const char *name;
    hn_joint_type type;
    int has_axis, needs_limit;
} TYPES[] = {{"revolute", HN_JOINT_REVOLUTE, 1, 1},   {"continuous", HN_JOINT_REVOLUTE, 1, 0},
             {"prismatic", HN_JOINT_PRISMATIC, 1, 1}, {"fixed", HN_JOINT_FIXED, 0, 0},
             {"floating", HN_JOINT_FREE, 0, 0},       {"planar", HN_JOINT_PLANAR, 1, 0}};
enum { N_TYPES = sizeof TYPES / sizeof *TYPES };

static int read_type(urdf *u, const xmlNode *node) {
    const char *names[N_TYPES], *word = need(u, node, "type");
    for (int k = 0; k < N_TYPES && word; k++) {
        names[k] = TYPES[k].name;
        if (strcmp(word, names[k]) == 0) {
            return k;
        }
    }
    if (word) {
        char hint[HN_DIAG_HINT];
        hn_im_fault(u->b, node, "type", hn_suggest(hint, word, names, N_TYPES, NULL),
                    "unknown joint type '%.40s'", word);
    }
    return -1;
}

static bool read_limits(urdf *u, const xmlNode *node, int kind, hn_im_joint *j) {
    const xmlNode *limit = hn_im_child(node, "limit");
    if (!limit) {
        return !TYPES[kind].needs_limit ||
               hn_im_fault(u->b, node, NULL, "or make it continuous",
                           "a %s joint needs its 'limit'", TYPES[kind].name);
    }

    // an empty range is a fault, one of no width is none
    hn_im_check_attributes(u->b, limit, LIMIT);
    if (hn_im_vector(u->b, limit, "lower", 1, &j->min) < 0 ||
        hn_im_vector(u->b, limit, "upper", 1, &j->max) < 0) {
        return false;
    }
    if (j->min > j->max) {
        return hn_im_fault(u->b, limit, NULL, NULL, "the range from %g to %g is empty", j->min,
                           j->max);
    }
    // many files write a range of no width for no range
    j->limited = TYPES[kind].needs_limit && j->min < j->max;
    if (TYPES[kind].needs_limit && !j->limited) {
        hn_im_note(u->b, HN_IMPORT_APPROXIMATED, limit, NULL,
                   "a range from %g to %g is taken as none", j->min, j->max);
    } else if (!TYPES[kind].needs_limit &&
               (hn_im_attr(u->b, limit, "lower") || hn_im_attr(u->b, limit, "upper"))) {
        hn_im_note(u->b, HN_IMPORT_IGNORED, limit, NULL, "a %s joint has no range",
                   TYPES[kind].name);
    }
    return true;
}

static bool read_axis(urdf *u, const xmlNode *node, int kind, hn_im_frame *in_child) {
    static const double nowhere[3] = {0, 0, 0};
    const xmlNode *element = hn_im_child(node, "axis");
    double axis[3] = {1, 0, 0};
    *in_child = hn_im_frame_unit();

    // types without axis
    if (!TYPES[kind].has_axis) {
        if (element) {
            hn_im_note(u->b, HN_IMPORT_IGNORED, element, NULL, "a %s joint has no axis",
                       TYPES[kind].name);
        }
        return true;
    }

    // x unless the file says otherwise
    if (element) {
        hn_im_check_attributes(u->b, element, AXIS);
        if (!need(u, element, "xyz") || hn_im_vector(u->b, element, "xyz", 3, axis) < 0) {
            return false;
        }
    }
    if (!hn_im_normalise(axis)) {
        return hn_im_fault(u->b, element, "xyz", NULL, "an axis of length 0");
    }
    *in_child = hn_im_axis_frame(nowhere, axis);
    return true;
}

static bool add_damping(urdf *u, const xmlNode *node, int joint) {
    const xmlNode *dynamics = hn_im_child(node, "dynamics");
    double damping = 0;
    if (!dynamics) {
        return true;
    }
    hn_im_check_attributes(u->b, dynamics, DYNAMICS);
    if (hn_im_vector(u->b, dynamics, "damping", 1, &damping) < 0) {
        return false;
    }
    if (damping < 0) {
        return hn_im_fault(u->b, dynamics, "damping", NULL, "a damping of %g is negative", damping);
    }

    // a damper along each coordinate
    for (int k = 0; k < u->b->joints[joint].n && damping > 0; k++) {
        hn_strbuf o;
        hn_strbuf_init(&o);
        hn_json_object(&o);
        hn_json_key(&o, "joint_spring");
        hn_json_object(&o);
        hn_json_put_string(&o, "coordinate", u->b->joints[joint].coordinate[k]);
        hn_json_put_number(&o, "damping", damping);
        hn_json_end_object(&o);
        hn_json_end_object(&o);
        if (!hn_im_add_text(u->b, &u->b->loads, &o)) {
            return false;
        }
    }
    return true;
}

static bool add_joint(urdf *u, int index) {
    const xmlNode *node = u->joints[index];
    const char *name = need(u, node, "name");
    int kind = name ? read_type(u, node) : -1, parent = u->body[u->parent[index]];

    // type, place and axis
    hn_im_frame origin, in_child;
    hn_im_check_attributes(u->b, node, JOINT);
    name_others(u, node, "origin parent child axis limit dynamics mimic");
    if (kind < 0 || !read_origin(u, node, &origin) || !read_axis(u, node, kind, &in_child)) {
        return false;
    }

    // the name, and the link that hangs on it
    hn_im_joint j = {.source = name, .type = TYPES[kind].type, .parent = parent};
    if (hn_im_find_joint(u->b, name) >= 0) {
        return hn_im_fault(u->b, node, "name", NULL, "two joints have the name '%.60s'", name);
    }
    hn_im_frame world = hn_im_frame_mul(&u->b->bodies[parent].world, &origin);
    if (!read_limits(u, node, kind, &j) || !add_link(u, u->child[index], &world)) {
        return false;
    }

    // where it sits in both
    hn_im_frame in_parent = hn_im_frame_mul(&origin, &in_child);
    j.child = u->body[u->child[index]];
    hn_im_set_sides(&j, &in_parent, &in_child);
    int joint = hn_im_add_joint(u->b, node, &j, name);
    return joint >= 0 && add_damping(u, node, joint);
}

/// q = multiplier q_other + offset
static bool add_mimic(urdf *u, const xmlNode *node) {
    const xmlNode *mimic = hn_im_child(node, "mimic");
    double multiplier = 1, offset = 0;
    if (!mimic) {
        return true;
    }
    hn_im_check_attributes(u->b, mimic, MIMIC);
    const char *other = need(u, mimic, "joint");
    if (!other || hn_im_vector(u->b, mimic, "multiplier", 1, &multiplier) < 0 ||
        hn_im_vector(u->b, mimic, "offset", 1, &offset) < 0) {
        return false;
    }

    // both joints have one coordinate
    int a = hn_im_find_joint(u->b, need(u, node, "name")), c = hn_im_find_joint(u->b, other);
    if (a < 0 || c < 0 || u->b->joints[a].n != 1 || u->b->joints[c].n != 1 || a == c) {
        return hn_im_fault(u->b, mimic, "joint", "name another joint with one coordinate",
                           "the joint cannot follow '%.60s'", other);
    }

    // a gear, or a fixed value where the multiplier is zero
    hn_strbuf o;
    hn_strbuf_init(&o);
    hn_json_object(&o);
    hn_json_put_string(&o, "name", hn_im_text(u->b, "mimic %.45s", u->b->joints[a].name));
    if (multiplier != 0) {
        hn_json_key(&o, "gear");
        hn_json_object(&o);
        hn_json_key(&o, "coordinates");
        hn_json_strings(
            &o, (const char *[]){u->b->joints[a].coordinate[0], u->b->joints[c].coordinate[0]}, 2);
        hn_json_put_number(&o, "ratio", -multiplier);
        hn_json_put_number(&o, "phase", offset);
    } else {
        hn_json_key(&o, "motion");
        hn_json_object(&o);
        hn_json_put_string(&o, "coordinate", u->b->joints[a].coordinate[0]);
        hn_json_put_number(&o, "value", offset);
    }
    hn_json_end_object(&o);
    hn_json_end_object(&o);
    u->b->n_closing++;
    return hn_im_add_text(u->b, &u->b->constraints, &o);
}

// ---- the tree ----

static int find_link(urdf *u, const xmlNode *joint, const char *side) {
    const xmlNode *node = hn_im_child(joint, side);
    if (!node) {
        hn_im_fault(u->b, joint, NULL, NULL, "the element '%s' is missing", side);
        return -1;
    }
    hn_im_check_attributes(u->b, node, SIDE);
    const char *name = need(u, node, "link");
    for (int i = 0; i < u->n_links && name; i++) {
        const char *other = hn_im_attr(u->b, u->links[i], "name");
        if (other && strcmp(other, name) == 0) {
            return i;
        }
    }
    if (name) {
        hn_im_fault(u->b, node, "link", NULL, "there is no link named '%.60s'", name);
    }
    return -1;
}

static bool check_names(urdf *u) {
    for (int i = 0; i < u->n_links; i++) {
        const char *name = need(u, u->links[i], "name");
        for (int k = 0; k < i && name; k++) {
            if (strcmp(need(u, u->links[k], "name"), name) == 0) {
                return hn_im_fault(u->b, u->links[i], "name", NULL,
                                   "two links have the name '%.60s'", name);
            }
        }
        if (!name) {
            return false;
        }
    }
    return true;
}

static bool collect(urdf *u) {
    // room for as many links and joints as there are elements
    int n = 0;
    for (const xmlNode *c = hn_im_first(u->root); c; c = hn_im_next(c)) {
        n++;
    }
    size_t room = (size_t)n + 1;
    u->links = hn_arena_get(u->b->arena, room * sizeof *u->links);
    u->joints = hn_arena_get(u->b->arena, room * sizeof *u->joints);
    u->parent = hn_arena_ints(u->b->arena, room);
    u->child = hn_arena_ints(u->b->arena, room);
    u->carrier = hn_arena_ints(u->b->arena, room);
    u->body = hn_arena_ints(u->b->arena, room);
    if (hn_arena_failed(u->b->arena)) {
        return hn_im_out_of_memory(u->b);
    }

    // one list each
    for (const xmlNode *c = hn_im_first(u->root); c; c = hn_im_next(c)) {
        if (hn_im_is(c, "link")) {
            u->links[u->n_links++] = c;
        } else if (hn_im_is(c, "joint")) {
            u->joints[u->n_joints++] = c;
        }
    }
    if (u->n_links > HN_SCENE_MAX_BODIES || u->n_joints > HN_SCENE_MAX_JOINTS) {
        return hn_im_fault(u->b, u->root, NULL, NULL, "more than %d links or %d joints",
                           HN_SCENE_MAX_BODIES, HN_SCENE_MAX_JOINTS);
    }
    name_others(u, u->root, "link joint");
    return check_names(u);
}

static bool link_up(urdf *u) {
    for (int i = 0; i < u->n_links; i++) {
        u->carrier[i] = u->body[i] = -1;
    }
    for (int k = 0; k < u->n_joints; k++) {
        u->parent[k] = find_link(u, u->joints[k], "parent");
        u->child[k] = u->parent[k] < 0 ? -1 : find_link(u, u->joints[k], "child");
        if (u->child[k] < 0) {
            return false;
        }
        if (u->carrier[u->child[k]] >= 0) {
            return hn_im_fault(u->b, u->joints[k], NULL,
                               "put the joint that closes the loop into the loop file",
                               "the link '%.60s' has two parents; URDF is a tree",
                               need(u, u->links[u->child[k]], "name"));
        }
        u->carrier[u->child[k]] = k;
    }
    return true;
}

static int find_root(urdf *u) {
    int root = -1;
    for (int i = 0; i < u->n_links; i++) {
        if (u->carrier[i] < 0 && root >= 0) {
            hn_im_fault(u->b, u->links[i], NULL, "join it to the rest by a joint",
                        "no joint carries the link '%.60s', nor '%.60s': the tree has one root",
                        need(u, u->links[i], "name"), need(u, u->links[root], "name"));
            return -1;
        }
        root = u->carrier[i] < 0 ? i : root;
    }
    if (root < 0) {
        hn_im_fault(u->b, u->root, NULL, NULL,
                    u->n_links ? "every link is carried by a joint: the joints run in a circle"
                               : "there is no link in this robot");
    }
    return root;
}

static bool mount(urdf *u, int root) {
    hn_im_frame unit = hn_im_frame_unit();
    hn_im_joint j = {.type = HN_JOINT_FIXED, .parent = HN_GROUND};
    if (!add_link(u, root, &unit)) {
        return false;
    }
    j.child = u->body[root];
    hn_im_set_sides(&j, &unit, &unit);
    hn_im_note(u->b, HN_IMPORT_APPROXIMATED, u->links[root], NULL,
               "the root of the tree is fixed to the ground");
    return hn_im_add_joint(u->b, u->links[root], &j,
                           hn_im_text(u->b, "%.40s_mount", u->b->bodies[j.child].name)) >= 0;
}

/// Joints whose parent is made, round after round.
static bool grow(urdf *u) {
    // joint by joint outwards from the root, as long as that finds new links
    for (int made = 1, left = u->n_joints; left > 0 && made;) {
        made = 0;
        for (int k = 0; k < u->n_joints; k++) {
            if (u->body[u->parent[k]] >= 0 && u->body[u->child[k]] < 0) {
                if (!add_joint(u, k)) {
                    return false;
                }
                made = 1;
                left--;
            }
        }
    }

    // what it never reached
    for (int i = 0; i < u->n_links; i++) {
        if (u->body[i] < 0) {
            return hn_im_fault(u->b, u->links[i], NULL, NULL,
                               "the link '%.60s' hangs in a circle of joints, not from the root",
                               need(u, u->links[i], "name"));
        }
    }
    return true;
}

bool hn_im_read_urdf(hn_build *b, const xmlNode *root) {
    urdf u = {.b = b, .root = root};
    b->gravity[2] = -9.81;
    hn_im_check_attributes(b, root, ROBOT);
    if (!collect(&u) || !link_up(&u)) {
        return false;
    }
    int first = find_root(&u);
    if (first < 0 || !mount(&u, first) || !grow(&u)) {
        return false;
    }
    for (int k = 0; k < u.n_joints; k++) {
        if (!add_mimic(&u, u.joints[k])) {
            return false;
        }
    }
    b->name = hn_im_attr(b, root, "name");
    return b->status == HN_OK;
}

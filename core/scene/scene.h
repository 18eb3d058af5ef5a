// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SCENE_SCENE_H
#define HN_SCENE_SCENE_H
// A scene is a mechanism as a person writes it down, checked. It is plain data, owned by its arena
// and constant after loading. There are two kinds: bodies and joints, or a Lagrangian; a scene of
// bodies may add the terms of a Lagrangian. The compiler (dynamics/compile) turns either into
// equations. Nothing here knows of trees, cut loops or methods.
//
// Body frame: any frame fixed to the body. A joint sits at `parent_at` in the parent's frame and at
// `child_at` in the child's; `axis` is given in both frames, and `ref` is a direction perpendicular
// to it in both, which coincide when the coordinate is 0. Ground is body HN_GROUND; its frame is
// the world: x right, y up, z to the viewer. SI units: m, kg, s, rad, N.

#include "base/arena.h"
#include "base/diag.h"

#include <stdbool.h>
#include <stdint.h>

enum { HN_GROUND = -1 };
/// Largest number of a scene: products of a mass, a length squared and a rate must stay finite.
#define HN_SCENE_MAX_NUMBER 1e100
enum {
    HN_SCENE_MAX_BYTES = 4 << 20,
    HN_SCENE_MAX_BODIES = 4000,
    HN_SCENE_MAX_JOINTS = 4000,
    HN_SCENE_MAX_PARAMS = 200
};

/// A number, or a formula in the parameters (then `formula` is its text and `value` its present
/// value). A formula that depends on the state (loads, Lagrangian, drawn points) has value 0 and
/// `varies` 1.
typedef struct hn_quantity {
    double value;
    const char *formula; ///< NULL for a plain number
    bool varies;
    const char *pointer; ///< JSON pointer, for messages of later stages; may be NULL for defaults
} hn_quantity;

typedef struct hn_param {
    const char *name, *unit, *about; ///< unit "" when dimensionless
    double value, initial, min, max; ///< initial: as the scene file says
    const char *formula; ///< of other parameters, which gave the value; NULL: a number was given
    bool integer;        ///< must stay whole (numbers of loops, links)
    bool structural;     ///< changes how many bodies there are
    /// set outside min..max: the mechanism can be built, but its texts speak of that range
    bool beyond;
} hn_param;

typedef struct hn_body {
    const char *name, *pointer;
    hn_quantity mass;       ///< [kg] >= 0
    hn_quantity com[3];     ///< centre of mass in the body frame [m]
    hn_quantity inertia[6]; ///< xx yy zz xy xz yz about the centre of mass, body axes [kg m^2]
} hn_body;

/// Degrees of freedom of the child against the parent, in the order of the joint's coordinates.
/// z is `axis`, x is `ref`, y = z cross x.
///   revolute     angle about z
///   prismatic    distance along z
///   cylindrical  angle about z, distance along z
///   universal    angle about the parent's z, then about the child's x
///   spherical    orientation: three entries of its rotation vector; their rates are the angular
///                velocity in the child's axes
///   planar       distances along the parent's x and y, angle about z
///   fixed        none
///   free         distances along the parent's x, y, z, then orientation
#define HN_JOINT_TYPE_LIST(X)              \
    X(HN_JOINT_REVOLUTE, "revolute")       \
    X(HN_JOINT_PRISMATIC, "prismatic")     \
    X(HN_JOINT_CYLINDRICAL, "cylindrical") \
    X(HN_JOINT_UNIVERSAL, "universal")     \
    X(HN_JOINT_SPHERICAL, "spherical")     \
    X(HN_JOINT_PLANAR, "planar")           \
    X(HN_JOINT_FIXED, "fixed")             \
    X(HN_JOINT_FREE, "free")
typedef enum hn_joint_type {
#define HN_JOINT_ENUM(code, name) code,
    HN_JOINT_TYPE_LIST(HN_JOINT_ENUM)
#undef HN_JOINT_ENUM
        HN_JOINT_TYPE_COUNT
} hn_joint_type;
const char *hn_joint_type_name(hn_joint_type type);

typedef struct hn_joint {
    const char *name, *pointer;
    hn_joint_type type;
    int parent, child; ///< body index or HN_GROUND
    hn_quantity parent_at[3], child_at[3];
    double parent_axis[3], child_axis[3]; ///< unit
    double parent_ref[3], child_ref[3];   ///< unit, perpendicular to the axis
    bool cut;          ///< asked to close a loop rather than to carry a coordinate
    int coordinate;    ///< index of its first coordinate, -1 for a fixed joint
    int n_coordinates; ///< their indices follow each other
    /// carries a coordinate of the Lagrangian's own in a scene of bodies: its body has no mass,
    /// nothing is drawn
    bool is_formal;
} hn_joint;

typedef enum hn_unit_kind { HN_ANGLE, HN_LENGTH, HN_OTHER } hn_unit_kind;

/// Every joint has one (a cut joint's follows from the others); a Lagrangian lists its own.
typedef struct hn_coordinate {
    const char *name, *rate; ///< th1, w1: as used in formulas; rate defaults to d_<name>
    hn_unit_kind kind;
    int joint; ///< index, or -1 (Lagrangian)
    int part;  ///< which degree of freedom of its joint: 0 .. n_coordinates - 1
    /// 0, 1, 2: entry of a rotation vector (spherical and free joints), -1: a coordinate of its own
    int turn;
    bool actuated;
    double min, max; ///< limits whose crossing is reported, -HUGE_VAL and HUGE_VAL: none
    // start: a pinned value is kept, a guess is where assembly begins
    double q0, v0;
    bool q0_given, q0_pinned, v0_given, v0_pinned;
    const char *q0_pointer, *v0_pointer;
    const char *q0_param, *v0_param; ///< the parameter that is the start, or NULL
} hn_coordinate;

/// A point fixed to a body, or (body HN_GROUND) a world point whose entries may depend on
/// coordinates in a Lagrangian scene.
typedef struct hn_point {
    const char *name; ///< label, or NULL
    int body;
    hn_quantity at[3];
} hn_point;

typedef enum hn_load_kind {
    HN_LOAD_SPRING, ///< between points p and q: stiffness [N/m], rest length [m], damping [N s/m]
    HN_LOAD_JOINT_SPRING, ///< along a coordinate: stiffness, rest value, damping
    /// generalised force `value[0]` on a coordinate (torque, motor, ...), formula of t, q, v
    HN_LOAD_COORDINATE,
    HN_LOAD_FORCE,  ///< force `value[3]` in world axes at point p, formula of t, q, v
    HN_LOAD_MOMENT, ///< moment `value[3]` [N m] in world axes on the body of point p
    /// actuator on a coordinate x that follows value[0] = target(t): stiffness (target - x) +
    /// damping (target' - x'), no more than value[1] either way if that is > 0
    HN_LOAD_FOLLOW,
    HN_LOAD_TABLE, ///< on a coordinate: `table` over time
    /// a hand that holds point p while the mechanism runs (dynamics/compile/pull.h); never in a
    /// scene file
    HN_LOAD_PULL
} hn_load_kind;

/// Values over time, times strictly increasing; before the first and after the last time the end
/// values hold.
typedef struct hn_profile {
    int n;
    const double *t, *value; ///< [s]
    bool steps;              ///< 1: each value holds until the next time, 0: straight lines between
} hn_profile;

typedef struct hn_load {
    const char *name, *pointer;
    hn_load_kind kind;
    int p, q;       ///< points (spring, force)
    int coordinate; ///< (joint spring, coordinate)
    hn_quantity stiffness, rest, damping;
    hn_quantity value[3];
    hn_profile table;
} hn_load;

/// Kinds of constraints that a scene of bodies may have in addition to its joints. `direction` and
/// `up` are given in the frame of the body of point q.
typedef enum hn_constraint_kind {
    HN_CONSTRAINT_DISTANCE, ///< a rod without mass: points p and q stay `value` apart [m]
    HN_CONSTRAINT_LINE,     ///< p stays on the line through q along `direction`
    /// p stays in the plane through q with normal `direction`, at the distance `value` [m]
    HN_CONSTRAINT_PLANE,
    HN_CONSTRAINT_GEAR, ///< x + ratio y = value, x and y the two coordinates
    /// a wheel with centre p and radius `value` rolls on the line through q along `direction`; its
    /// centre stays on the side `up` of the line, its axle parallel to direction cross up
    HN_CONSTRAINT_ROLLING,
    /// value = 0, a formula of t and coordinates (a prescribed motion: "th1 - w*t")
    HN_CONSTRAINT_FORMULA
} hn_constraint_kind;

typedef struct hn_constraint {
    const char *name, *pointer;
    hn_constraint_kind kind;
    int p, q;            ///< points; -1 where the kind has none
    double direction[3]; ///< unit, in the axes of q's body
    double up[3];        ///< rolling: unit, perpendicular to it
    int coordinate[2];   ///< gear
    hn_quantity ratio, value;
} hn_constraint;

/// Formulas of a Lagrangian in coordinates, rates, t and parameters. In a scene of bodies too, the
/// energies are added to theirs, and the constraints are among the scene's.
typedef struct hn_lagrangian {
    hn_quantity kinetic, potential;
    int n_constraints;
    hn_quantity *constraints;
    const char **constraint_names; ///< "loop x" ...; never NULL
} hn_lagrangian;

typedef enum hn_shape_kind {
    HN_SHAPE_BAR,     ///< rounded bar from p to q, width
    HN_SHAPE_PIVOT,   ///< a pin at p
    HN_SHAPE_GROUND,  ///< hatched support at p
    HN_SHAPE_SLIDER,  ///< box at p sliding along the line p..q
    HN_SHAPE_GUIDE,   ///< the fixed guide through p in direction q - p
    HN_SHAPE_SPRING,  ///< zigzag from p to q
    HN_SHAPE_DAMPER,  ///< pot from p to q
    HN_SHAPE_ARROW,   ///< load at p
    HN_SHAPE_POLYGON, ///< p, q, r, ... closed (n points from `first`)
    HN_SHAPE_TRACE    ///< p leaves a trace
} hn_shape_kind;
/// The word of the scene file.
const char *hn_shape_kind_name(hn_shape_kind kind);

typedef struct hn_shape {
    hn_shape_kind kind;
    int p, q, n;  ///< point indices; polygon: points p .. p + n - 1
    double width; ///< [m], 0: let the drawer choose
    int body;     ///< body it belongs to (for colouring), HN_GROUND if none
    /// of a pivot or a support: the joint there, whose symbol is drawn; a pin where it is neither
    /// spherical nor universal
    hn_joint_type joint;
} hn_shape;

typedef struct hn_scene {
    hn_arena *arena; ///< owns everything below
    const char *id, *name, *title, *about,
        *look_for;       ///< id: file name without .json, or the "id" field
    const char *exhibit; ///< what its own methods are meant to show going wrong; "": nothing
    bool is_lagrangian;  ///< no bodies at all
    bool has_formulas;   ///< a scene of bodies to which `lagrangian` adds energies
    int n_params, n_bodies, n_joints, n_coordinates, n_points, n_loads, n_constraints, n_shapes;
    hn_param *params;
    hn_body *bodies;
    hn_joint *joints;
    hn_coordinate *coordinates;
    hn_point *points;
    hn_load *loads;
    hn_constraint *constraints;
    hn_shape *shapes; ///< as the scene says, or made from its joints when it says nothing
    int n_tears;      ///< Lagrangian only: pairs of points that coincide when the loop is closed
    int (*tears)[2];
    hn_quantity gravity[3]; ///< acceleration of gravity [m/s^2], world axes; Lagrangian: 0
    hn_lagrangian lagrangian;
    /// assembly mode asked for: "open", "crossed", "+", "-" (one sign per loop: "+-+"), NULL: any
    const char *mode;
    double duration, step;      ///< suggested [s]
    const char *const *methods; ///< suggested method spellings
    int n_methods;
    /// the scene file without its spaces: with the parameter values it is this very scene
    const char *text;
    uint64_t hash; ///< of what moves and the present parameter values: not of words or drawing
} hn_scene;

/// One changed parameter, as from --set l1=1.2; or, named start.NAME, the value at which a
/// coordinate or rate starts: assembly begins there, whatever the scene says.
typedef struct hn_setting {
    const char *name;
    double value;
} hn_setting;

/// Reads a scene from JSON text (n bytes; it need not be terminated).
///
/// id        in  name of the scene, or NULL: its own "id" or "name"
/// settings  in  values that replace those of parameters
/// out       out owned; free with hn_scene_free()
/// diags     out every fault that the text alone shows, up to HN_DIAG_MAX: syntax with line and
///               column, unknown or missing fields with a near name, wrong types, units, ranges,
///               names used twice, bodies that are not connected, inertia that no body has
/// Fails: HN_ERR_INPUT, HN_ERR_LIMIT (too large), HN_ERR_MEMORY
HN_MUST_CHECK hn_status hn_scene_load_json(const char *text, size_t n, const char *id,
                                           const hn_setting *settings, int n_settings,
                                           hn_scene **out, hn_diags *diags);
/// Reads a scene from a file. Fails also: HN_ERR_IO
HN_MUST_CHECK hn_status hn_scene_load_file(const char *path, const hn_setting *settings,
                                           int n_settings, hn_scene **out, hn_diags *diags);
void hn_scene_free(hn_scene *scene); ///< NULL is legal
/// Adds a load of kind HN_LOAD_PULL on a point; nothing holds it yet. The hash of the scene stays.
/// Fails: HN_ERR_INPUT (no such point), HN_ERR_MEMORY
HN_MUST_CHECK hn_status hn_scene_add_pull(hn_scene *scene, int point);

/// "rad", "m", or `none` for a coordinate that is neither an angle nor a length.
const char *hn_coordinate_unit(const hn_coordinate *c, const char *none);
int hn_scene_find_coordinate(const hn_scene *scene, const char *name); ///< index by name, or -1
/// Index of the parameter; -1: there is none of this name.
int hn_scene_find_param(const hn_scene *scene, const char *name);
/// Returns the coordinate or rate that a setting moves the start of ("th1" of "start.th1"); NULL
/// when the setting is a parameter's, or NULL.
const char *hn_scene_start_name(const char *setting);
int hn_scene_find_body(const hn_scene *scene,
                       const char *name); ///< "ground" gives HN_GROUND; unknown: -2

#endif

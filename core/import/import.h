#ifndef HN_IMPORT_IMPORT_H
#define HN_IMPORT_IMPORT_H
// Mechanisms written for other programs, read into a scene of ours: MuJoCo's MJCF, and URDF with a list of the joints that
// close its loops. The scene comes as JSON text that the loader of scene/ has accepted. Whatever of the file is not in
// the scene is in the notes, one for each element or attribute, with its line: nothing is dropped silently.
//
// What closes a loop (an equality `connect` or `weld`, a joint of the loop file) becomes a joint that is marked as cut, so that
// the file's own tree carries the coordinates. Coordinates are those of the file: 0 means what it means there.

#include "base/diag.h"
#include "scene/scene.h"

enum { HN_IMPORT_MAX_BYTES = 4 << 20, HN_IMPORT_MAX_DEPTH = 100, HN_IMPORT_MAX_NOTES = 5000 };

typedef enum hn_import_outcome {
    HN_IMPORT_IGNORED,      ///< changes nothing about how the mechanism moves
    HN_IMPORT_APPROXIMATED, ///< is in the scene in another way
    HN_IMPORT_REFUSED,      ///< would change the motion, and is not in the scene
    HN_IMPORT_OUTCOME_COUNT
} hn_import_outcome;
const char *hn_import_outcome_name(hn_import_outcome outcome); ///< "ignored" ...

typedef struct hn_import_note {
    hn_import_outcome outcome;
    int line;          ///< of the element in the file, from 1
    const char *where; ///< "/mujoco/worldbody/body[2]/joint/@armature"
    const char *what;  ///< what was done and why, one sentence
} hn_import_note;

typedef struct hn_import_source {
    const char *text; ///< XML
    size_t n;
    const char *name;  ///< of the scene; the model's own when NULL
    const char *loops; ///< loop file: JSON, or NULL
    size_t n_loops;
    const char *key; ///< MJCF: keyframe to start from, by name; NULL: the first one; "qpos0": none
} hn_import_source;

typedef struct hn_import hn_import;

/// Reads MJCF or URDF, whichever the root element says. Returns owned in *out. Fails: HN_ERR_INPUT, HN_ERR_LIMIT, with
/// line and column or line and path of each fault; HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_import_read(const hn_import_source *source, hn_import **out,
                                       hn_diags *diags);
void hn_import_free(hn_import *import); ///< NULL is legal

const char *hn_import_format(const hn_import *import);           ///< "MJCF" or "URDF"
const char *hn_import_scene(const hn_import *import, size_t *n); ///< JSON text
int hn_import_note_count(const hn_import *import);
const hn_import_note *hn_import_note_at(const hn_import *import, int i);
int hn_import_count(const hn_import *import, hn_import_outcome outcome);

/// What is in the scene.
typedef struct hn_import_info {
    int n_bodies, n_carriers; ///< carriers: bodies without mass between several joints of one body
    int n_joints, n_closing, n_constraints, n_loads, n_params;
    double mass;   ///< of all bodies [kg]
    double com[3]; ///< of all bodies at the model's zero pose, world axes [m]
} hn_import_info;
hn_import_info hn_import_get_info(const hn_import *import);
#endif

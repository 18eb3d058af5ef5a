// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_IMPORT_H
#define HN_IMPORT_IMPORT_H
// Mechanisms written for other programs, read into a scene of ours: MuJoCo's MJCF with the files it
// includes, and URDF with a list of the joints that close its loops. The scene comes as JSON text
// that the loader of scene/ has accepted. The notes list all parts of the file that are not in the
// scene, one for each element or attribute, with its line: nothing is dropped silently.
//
// What closes a loop (an equality `connect` or `weld`, a joint of the loop file) becomes a joint
// that is marked as cut, so that the file's own tree carries the coordinates. Coordinates are those
// of the file: 0 means what it means there.

#include "base/diag.h"
#include "base/strbuf.h"
#include "scene/scene.h"

enum {
    HN_IMPORT_MAX_BYTES = 4 << 20, ///< of all files of a model together
    HN_IMPORT_MAX_DEPTH = 100,     ///< elements within each other
    HN_IMPORT_MAX_NOTES = 5000,
    HN_IMPORT_MAX_FILES = 64,        ///< of a model, its own among them
    HN_IMPORT_MAX_INCLUDES_DEEP = 10 ///< files that include files
};

typedef enum hn_import_outcome {
    HN_IMPORT_IGNORED,      ///< changes nothing about how the mechanism moves
    HN_IMPORT_APPROXIMATED, ///< is in the scene in another way
    HN_IMPORT_REFUSED,      ///< would change the motion, and is not in the scene
    HN_IMPORT_OUTCOME_COUNT
} hn_import_outcome;
const char *hn_import_outcome_name(hn_import_outcome outcome); ///< "ignored" ...

typedef struct hn_import_note {
    hn_import_outcome outcome;
    const char *file; ///< the included file that holds it; NULL: the model's own
    int line;         ///< of the element in its file, from 1
    /// "/mujoco/worldbody/body[2]/joint/@armature", with all files in their places
    const char *where;
    const char *what; ///< what was done and why, one sentence
} hn_import_note;

/// Adds the text of a file that a model includes to `text`, but no more than `most` + 1 bytes of
/// it. `name` is relative to the folder of the model's own file and stays below it:
/// "parts/leg.xml". HN_ERR_IO with the reason in diag.
typedef hn_status (*hn_import_reader)(void *user, const char *name, size_t most, hn_strbuf *text,
                                      hn_diag *diag);

typedef struct hn_import_source {
    const char *text; ///< XML
    size_t n;
    const char *name;  ///< of the scene; the model's own when NULL
    const char *loops; ///< loop file: JSON, or NULL
    size_t n_loops;
    const char *key;  ///< MJCF: keyframe to start from, by name; NULL: the first one; "qpos0": none
    const char *file; ///< name of the model's own file, that no other may include; NULL: not known
    hn_import_reader read; ///< NULL: a model that includes files is refused
    void *user;            ///< for `read`
} hn_import_source;

typedef struct hn_import hn_import;

/// Reads MJCF or URDF, whichever the root element says. Returns owned in *out. Fails: HN_ERR_INPUT,
/// HN_ERR_LIMIT, HN_ERR_IO (a file that is included), with line and column or line and path of each
/// fault; HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_import_read(const hn_import_source *source, hn_import **out,
                                       hn_diags *diags);
void hn_import_free(hn_import *import); ///< NULL is legal

const char *hn_import_format(const hn_import *import);           ///< "MJCF" or "URDF"
const char *hn_import_scene(const hn_import *import, size_t *n); ///< JSON text
/// Notes about elements of the file: their number, note i, and the number of notes with this
/// outcome.
int hn_import_note_count(const hn_import *import);
const hn_import_note *hn_import_note_at(const hn_import *import, int i);
int hn_import_count(const hn_import *import, hn_import_outcome outcome);
/// Writes "notes": all of them as [{"outcome", "file", "line", "where", "what"}]; "file" where an
/// element stands in another file than the first.
void hn_import_put_notes(hn_strbuf *b, const hn_import *import);

/// The content of the scene.
typedef struct hn_import_info {
    int n_bodies, n_carriers; ///< carriers: bodies without mass between several joints of one body
    int n_joints, n_closing, n_constraints, n_loads, n_params;
    double mass;   ///< of all bodies [kg]
    double com[3]; ///< of all bodies at the model's zero pose, world axes [m]
} hn_import_info;
hn_import_info hn_import_get_info(const hn_import *import);
#endif

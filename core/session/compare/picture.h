// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PICTURE_H
#define HN_SESSION_PICTURE_H
// Draws a mechanism without a display: the poses that several methods reached at one time, or one
// given pose.

#include "base/interrupt.h"
#include "render/look.h"
#include "session/model/model.h"

#include <stdbool.h>

enum { HN_PICTURE_TIMES = 60, HN_PICTURE_TRACES = 16 };

typedef enum hn_picture_form {
    HN_PICTURE_PNG, ///< several moments: side by side
    HN_PICTURE_SVG,
    HN_PICTURE_APNG ///< several moments: one after another
} hn_picture_form;

typedef struct hn_picture_request {
    const char *const
        *methods;        ///< spellings; NULL: one pose, the start with `entries` in their places
    int n_methods;       ///< at most HN_COMPARISON_MAX_METHODS
    double time;         ///< [s], with methods
    const double *times; ///< n_times of them [s], with methods: several moments in one file
    int n_times;         ///< at most HN_PICTURE_TIMES; 0: `time` alone
    bool ghosts;         ///< one picture of the last moment, the first method's earlier poses faint
    bool dimensions;     ///< lengths of bars
    bool forces;         ///< in the joints, of the first method [N]
    const char *const *traces; ///< n_traces labels of points whose paths are drawn
    int n_traces;              ///< beside those that the scene traces; at most HN_PICTURE_TRACES
    hn_picture_form form;
    int delay; ///< [ms] for which a moment stands in an animation; 1 to 65,535
    const hn_state_entry *entries;
    int n_entries;
    /// another pose of the same scene, drawn beneath the one of `entries` as what is expected;
    /// NULL: none
    const hn_state_entry *expected;
    int n_expected;
    const double
        *lines; ///< n_lines points drawn with one pose (3 each, world [m]; NaN: a new line)
    int n_lines;
    const char *caption; ///< NULL: the scene's
    int width, height;   ///< [px]; 0: 1200 x 720
    hn_theme theme;
    /// spelling of hn_view_parse(); NULL: the front view, or an oblique view for a spatial
    /// mechanism
    const char *view;
    double cpu_limit;        ///< computing time allowed [s], then HN_ERR_LIMIT; 0: no limit
    int (*stop)(void *user); ///< asked every few milliseconds; 1: HN_ERR_LIMIT. May be NULL
    void *user;
    const hn_interrupt *interrupt; ///< ends painting and writing: HN_ERR_STOPPED. May be NULL
    /// receives the name and the note of the first method that ended early; NULL: not asked for
    hn_strbuf *ending;
    /// receives the larger of the width and the height of the mechanism [px]; NULL: not asked for
    double *mechanism;
} hn_picture_request;

/// Appends the bytes of a PNG or SVG file to `file`. `description` (may be NULL) receives the
/// contents of the picture as JSON: {"scene","width","height","renderer","words","time",
/// "methods":{...},"picture":{...},"before":[...]}, with the summary of the comparison under
/// "methods". The last of several moments is "picture", the others are "before", latest first.
/// A method that ended early is drawn at its last good state, with the reason in the legend; *ended
/// (may be NULL) is then its status.
/// Fails: HN_ERR_INPUT, HN_ERR_LIMIT, HN_ERR_UNSUPPORTED (OSMesa gives no context), HN_ERR_STOPPED,
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_model_picture(hn_strbuf *file, hn_strbuf *description,
                                         const hn_model *model, const hn_picture_request *request,
                                         hn_status *ended, hn_diags *diags);

#endif

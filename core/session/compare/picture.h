// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PICTURE_H
#define HN_SESSION_PICTURE_H
// Draws a mechanism without a display: the poses that several methods reached at one time, or one
// given pose.

#include "render/look.h"
#include "session/model/model.h"

typedef struct hn_picture_request {
    const char *const
        *methods;  ///< spellings; NULL: one pose, the start with `entries` in their places
    int n_methods; ///< at most HN_COMPARISON_MAX_METHODS
    double time;   ///< [s], with methods
    const hn_state_entry *entries;
    int n_entries;
    const char *caption; ///< NULL: the scene's
    int width, height;   ///< [px]; 0: 1200 x 720
    hn_theme theme;
    /// spelling of hn_view_parse(); NULL: the front view, or an oblique view for a spatial
    /// mechanism
    const char *view;
    double cpu_limit;        ///< computing time allowed [s], then HN_ERR_LIMIT; 0: no limit
    int (*stop)(void *user); ///< asked every few milliseconds; 1: HN_ERR_LIMIT. May be NULL
    void *user;
} hn_picture_request;

/// Appends the bytes of a PNG file to `png`. `describe` (may be NULL) receives the contents of the
/// picture as JSON:
/// {"scene","width","height","time","methods":{...},"picture":{...}}, with the summary of the
/// comparison under "methods".
/// A method that ended early is drawn at its last good state, with the reason in the legend; *ended
/// (may be NULL) is then its status.
/// Fails: HN_ERR_INPUT, HN_ERR_LIMIT, HN_ERR_UNSUPPORTED (no renderer), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_model_picture(hn_strbuf *png, hn_strbuf *describe, const hn_model *model,
                                         const hn_picture_request *request, hn_status *ended,
                                         hn_diags *diags);

#endif

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SCENE_REQUEST_H
#define HN_HTTP_SCENE_REQUEST_H
// The scene that a request names, with the parameters that differ: read from a body or a query,
// kept, loaded.

#include "base/diag.h"
#include "base/interrupt.h"
#include "base/strbuf.h"
#include "scene/scene.h"
#include "session/model/library.h"
#include "session/model/model.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

enum { HN_SCENE_REQUEST_PULLS = 8 };

/// The request of a model; owns copies of everything it names.
typedef struct hn_scene_request {
    char *name, *text; ///< one of them
    int n;
    hn_setting settings[HN_SCENE_MAX_PARAMS];
    char *names[HN_SCENE_MAX_PARAMS];
    int n_pulls, pulls[HN_SCENE_REQUEST_PULLS]; ///< points that a hand may pull
} hn_scene_request;

/// From the members "scene" and "parameters". Start from a zeroed order; hn_scene_request_reset()
/// afterwards in any case.
HN_MUST_CHECK hn_status hn_scene_request_read(hn_scene_request *order, const cJSON *body,
                                              hn_diags *diags);
/// The settings alone; those that were there are forgotten.
HN_MUST_CHECK hn_status hn_scene_request_read_settings(hn_scene_request *order,
                                                       const cJSON *settings, hn_diags *diags);
/// Adds a parameter. Fails: HN_ERR_INPUT (not finite, or it is there already), HN_ERR_LIMIT,
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_scene_request_add(hn_scene_request *order, const char *name,
                                             size_t n_name, double value, hn_diags *diags);
/// Lets a hand pull a point too; one that it may pull already changes nothing.
HN_MUST_CHECK hn_status hn_scene_request_add_pull(hn_scene_request *order, int point,
                                                  hn_diags *diags);
/// Gives a parameter this value, whether it is there already or not. Fails as above.
HN_MUST_CHECK hn_status hn_scene_request_set(hn_scene_request *order, const hn_setting *setting,
                                             hn_diags *diags);
HN_MUST_CHECK hn_status hn_scene_request_copy(hn_scene_request *to, const hn_scene_request *from);
void hn_scene_request_reset(hn_scene_request *order);
/// Loads; pointers of faults inside a scene object begin with "/scene". `interrupt` ends the work
/// early, now or when the model is used later: HN_ERR_STOPPED. What it reads must outlive the
/// model.
HN_MUST_CHECK hn_status hn_scene_request_load(const hn_scene_request *order, const hn_library *lib,
                                              bool allow_open, hn_interrupt interrupt,
                                              hn_model **out, hn_diags *diags);
/// {"l1": 1.2}
void hn_scene_request_settings_json(hn_strbuf *b, const hn_scene_request *order);
#endif

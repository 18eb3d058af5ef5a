// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_PULLS_H
#define HN_HTTP_PULLS_H
// The hand that pulls, as requests write it: one pull, and the list of all of them.

#include "http/request/scene_request.h"
#include "session/compare/comparison.h"

/// Reads an object that the field table has checked: {"point","to","stiffness","damping"}. What is
/// left out of the spring is -1: chosen later.
hn_pull hn_pull_read(const cJSON *object);

/// The list of the user's pulls, in order of time; owned.
typedef struct hn_pull_list {
    hn_pull_event *at;
    int n;
} hn_pull_list;
void hn_pull_list_reset(hn_pull_list *list);
/// Reads [[frame, point, x, y, z, stiffness, damping], ...] in order of frames. NULL: none. Fails:
/// HN_ERR_INPUT, with the entry at fault in diags; HN_ERR_LIMIT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_pull_list_read(const cJSON *array, hn_pull_list *list, hn_diags *diags);
/// The list of a comparison, for one whose frames have another length.
HN_MUST_CHECK hn_status hn_pull_list_copy(const hn_comparison *from, double frame_dt,
                                          hn_pull_list *list);
/// Makes the scene's pulls those that the list needs.
HN_MUST_CHECK hn_status hn_pull_list_name_points(const hn_pull_list *list, hn_scene_request *scene,
                                                 hn_diags *diags);
/// Gives the list to a comparison at its frame 0.
HN_MUST_CHECK hn_status hn_pull_list_give(const hn_pull_list *list, hn_comparison *c,
                                          hn_diags *diags);
/// Writes the list of a comparison from its `first` entry on, each after a comma but the first of
/// all.
void hn_pulls_json(hn_strbuf *b, const hn_comparison *c, int first);

#endif

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_CATALOGUE_H
#define HN_HTTP_CATALOGUE_H
// Lists of what the server offers: the index with the bounds, scenes, methods, looks, lessons,
// problems, kinds of errors, health.

#include "session/model/model.h"

#include <stdbool.h>

struct hn_request;

/// Loads the scene in the path, with the settings of the query; NULL with a problem as reply.
hn_model *hn_catalogue_load_scene(struct hn_request *r, bool allow_open);

/// A function for each row of routes.c, which says method and path; the reply is in `r`.
void hn_handle_index(struct hn_request *r);
void hn_handle_health(struct hn_request *r);
void hn_handle_scenes(struct hn_request *r);
void hn_handle_scene(struct hn_request *r);
void hn_handle_reference(struct hn_request *r);
void hn_handle_methods(struct hn_request *r);
void hn_handle_look(struct hn_request *r);
void hn_handle_lessons(struct hn_request *r);
/// One lesson as a tree of blocks (lesson/lesson.h).
void hn_handle_lesson(struct hn_request *r);
void hn_handle_problems(struct hn_request *r);
void hn_handle_errors(struct hn_request *r);
void hn_handle_error(struct hn_request *r);
#endif

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_EXPORTS_H
#define HN_HTTP_EXPORTS_H
// Mechanisms as programs in other languages.

struct hn_request;

/// A function for each row of routes.c, which says method and path; the reply is in `r`.
void hn_handle_languages(struct hn_request *r);
void hn_handle_scene_export(struct hn_request *r); ///< of a shipped scene: query
void hn_handle_run_export(struct hn_request *r);
void hn_handle_export(struct hn_request *r); ///< of any scene: body
#endif

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STATELESS_H
#define HN_HTTP_STATELESS_H
// Questions that are one POST and one answer.

struct hn_request;

/// A function for each row of routes.c, which says method and path; the reply is in `r`.
void hn_handle_terms(struct hn_request *r);
void hn_handle_assemble(struct hn_request *r);
void hn_handle_drag(struct hn_request *r);
void hn_handle_inspect(struct hn_request *r);
void hn_handle_equations(struct hn_request *r);
void hn_handle_snapshot(struct hn_request *r);
void hn_handle_grade(struct hn_request *r);
void hn_handle_problem(struct hn_request *r);
#endif

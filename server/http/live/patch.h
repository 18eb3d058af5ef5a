// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_PATCH_H
#define HN_HTTP_PATCH_H
// Changes of a comparison.

#include "http/live/session_state.h"

/// Carries out the body of a PATCH and fills in the reply. On the session's thread, without the
/// lock.
void hn_session_apply(hn_session *session, hn_request *r);
#endif

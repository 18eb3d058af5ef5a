// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_HISTORY_H
#define HN_HTTP_HISTORY_H
// The last events of a comparison, so that a reader that was cut off goes on without a gap. Ids
// start at 1 and only grow; the oldest events go when there are too many or they hold too many
// bytes. Not locked: the comparison is.

#include "base/strbuf.h"

#include <stdint.h>

enum { HN_EVENT_MAX_EXTRAS = 3 };

#define HN_EVENT_LIST(X)             \
    X(HN_EVENT_FRAME, "frame")       \
    X(HN_EVENT_SLOW, "slow")         \
    X(HN_EVENT_INCIDENT, "incident") \
    X(HN_EVENT_RESET, "reset")       \
    X(HN_EVENT_STATE, "state")       \
    X(HN_EVENT_END, "end")

typedef enum hn_event_kind {
#define HN_EVENT_ENUM(kind, name) kind,
    HN_EVENT_LIST(HN_EVENT_ENUM)
#undef HN_EVENT_ENUM
        HN_EVENT_COUNT
} hn_event_kind;
/// The word after "event:" in a stream.
const char *hn_event_name(hn_event_kind kind);

typedef struct hn_event {
    uint64_t id;
    hn_event_kind kind;
    char *data; ///< one line of JSON; NULL when memory ran out (readers are told of a gap)
    size_t n;
    /// For an object with optional members: where its other members end, then where each optional
    /// member ends (",\"name\":value"); its last byte closes the object. All 0: no such members.
    size_t extra[HN_EVENT_MAX_EXTRAS + 1];
} hn_event;

typedef struct hn_history {
    hn_event *ring;
    int cap, n, head;
    size_t bytes, max_bytes;
    uint64_t last_id, last_frame_id; ///< 0: none yet
} hn_history;

/// An empty history that keeps at most so many events and bytes. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_history_init(hn_history *h, int max_events, size_t max_bytes);
void hn_history_reset(hn_history *h); ///< frees; a zeroed one is legal
/// Takes the buffer's text. The newest event is always kept, however large.
void hn_history_add(hn_history *h, hn_event_kind kind, hn_strbuf *data);
/// The same; `extra` as in hn_event.
void hn_history_add_parts(hn_history *h, hn_event_kind kind, hn_strbuf *data,
                          const size_t extra[HN_EVENT_MAX_EXTRAS + 1]);
/// The oldest id that is still there (last_id + 1 when nothing is).
uint64_t hn_history_first_id(const hn_history *h);
/// NULL when it is gone or has not come yet.
const hn_event *hn_history_find(const hn_history *h, uint64_t id);
#endif

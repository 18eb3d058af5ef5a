// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/ground/stream_socket.h"

#include <sys/socket.h>

/// The system takes twice as much. The second is what Linux grants unless its bound was raised
/// (net.core.wmem_max); a chunk of events, which may be on its way, has 64 kB [byte].
enum { WHILE_IT_LASTS = 64 << 10, AT_ITS_END = 208 << 10 };

static void set_buffer(int fd, int bytes) {
    if (fd >= 0) {
        setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
    }
}

void hn_stream_socket_begin(int fd) {
    set_buffer(fd, WHILE_IT_LASTS);
}

void hn_stream_socket_end(int fd) {
    set_buffer(fd, AT_ITS_END);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STREAM_SOCKET_H
#define HN_HTTP_STREAM_SOCKET_H
// The system's buffer of a stream of events. While the stream lasts it is short, so that a reader
// that lags does so in the history, where frames can be left out, and not in the system. At the end
// of the server it grows: the last events have room there, whether the reader reads now or later.

/// Shortens the buffer of a socket whose stream begins. -1 is legal.
void hn_stream_socket_begin(int fd);
/// Makes room for the last events. -1 is legal.
void hn_stream_socket_end(int fd);
#endif

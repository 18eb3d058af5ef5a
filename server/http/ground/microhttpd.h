// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_MICROHTTPD_H
#define HN_HTTP_MICROHTTPD_H
// libmicrohttpd, loaded when the server starts and kept: it brings GnuTLS and eight libraries more,
// which no other command needs. After hn_microhttpd_load its functions are called by their own
// names.

#include "base/diag.h"

#include <microhttpd.h>

/// The functions that the server needs; the names are theirs.
#define HN_MICROHTTPD_LIST(X)            \
    X(MHD_add_response_header)           \
    X(MHD_create_response_from_buffer)   \
    X(MHD_create_response_from_callback) \
    X(MHD_create_response_from_fd)       \
    X(MHD_destroy_response)              \
    X(MHD_get_connection_info)           \
    X(MHD_get_connection_values)         \
    X(MHD_get_response_header)           \
    X(MHD_lookup_connection_value)       \
    X(MHD_queue_response)                \
    X(MHD_resume_connection)             \
    X(MHD_start_daemon)                  \
    X(MHD_stop_daemon)                   \
    X(MHD_suspend_connection)

typedef struct hn_microhttpd {
#define HN_MICROHTTPD_MEMBER(name) __typeof__(name) *name;
    HN_MICROHTTPD_LIST(HN_MICROHTTPD_MEMBER)
#undef HN_MICROHTTPD_MEMBER
} hn_microhttpd;

/// Filled by hn_microhttpd_load, and constant from then on.
extern hn_microhttpd hn_microhttpd_functions;

/// Loads the library once, from any thread. Fails: HN_ERR_UNSUPPORTED, with the package to install.
HN_MUST_CHECK hn_status hn_microhttpd_load(hn_diag *diag);

#ifndef HN_MICROHTTPD_OWN_NAMES
#define MHD_add_response_header hn_microhttpd_functions.MHD_add_response_header
#define MHD_create_response_from_buffer hn_microhttpd_functions.MHD_create_response_from_buffer
#define MHD_create_response_from_callback hn_microhttpd_functions.MHD_create_response_from_callback
#define MHD_create_response_from_fd hn_microhttpd_functions.MHD_create_response_from_fd
#define MHD_destroy_response hn_microhttpd_functions.MHD_destroy_response
#define MHD_get_connection_info hn_microhttpd_functions.MHD_get_connection_info
#define MHD_get_connection_values hn_microhttpd_functions.MHD_get_connection_values
#define MHD_get_response_header hn_microhttpd_functions.MHD_get_response_header
#define MHD_lookup_connection_value hn_microhttpd_functions.MHD_lookup_connection_value
#define MHD_queue_response hn_microhttpd_functions.MHD_queue_response
#define MHD_resume_connection hn_microhttpd_functions.MHD_resume_connection
#define MHD_start_daemon hn_microhttpd_functions.MHD_start_daemon
#define MHD_stop_daemon hn_microhttpd_functions.MHD_stop_daemon
#define MHD_suspend_connection hn_microhttpd_functions.MHD_suspend_connection
#endif
#endif

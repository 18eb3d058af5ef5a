// SPDX-License-Identifier: GPL-3.0-or-later
#define HN_MICROHTTPD_OWN_NAMES // of the library itself, not of the loaded functions
#include "http/ground/microhttpd.h"

#include "base/late_library.h"

#include <pthread.h>

static const char *const FILES[] = {"libmicrohttpd.so.12", "libmicrohttpd.so", NULL};

hn_microhttpd hn_microhttpd_functions;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static hn_late_library library = {
    .name = "libmicrohttpd", .package = "libmicrohttpd12", .files = FILES};

static void load(void) {
    hn_microhttpd *f = &hn_microhttpd_functions;
#define FIND(name) &&hn_late_library_find(&library, #name, &f->name)
    (void)(hn_late_library_open(&library) HN_MICROHTTPD_LIST(FIND));
#undef FIND
}

hn_status hn_microhttpd_load(hn_diag *diag) {
    pthread_once(&once, load);
    return hn_late_library_check(&library, "the server cannot start", diag);
}

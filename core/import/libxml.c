// SPDX-License-Identifier: GPL-3.0-or-later
#define HN_LIBXML_OWN_NAMES // the names of the library itself, not those of the loaded functions
#include "import/libxml.h"

#include "base/late_library.h"

#include <pthread.h>

static const char *const FILES[] = {"libxml2.so.16", "libxml2.so.2", "libxml2.so", NULL};

hn_libxml hn_libxml_functions;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static hn_late_library library = {.name = "libxml2", .package = "libxml2", .files = FILES};

static void load(void) {
    hn_libxml *f = &hn_libxml_functions;
    if (!hn_late_library_open(&library)) {
        return;
    }
#define FIND(name) &&hn_late_library_find(&library, #name, &f->name)
    const bool all = true HN_LIBXML_LIST(FIND);
#undef FIND
    if (all) {
        (void)hn_late_library_find(&library, "xmlFree", &f->free);
    }
}

hn_status hn_libxml_load(hn_diag *diag) {
    pthread_once(&once, load);
    return hn_late_library_check(&library, "no MJCF or URDF file can be read", diag);
}

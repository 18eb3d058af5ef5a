// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/osmesa.h"

#include "base/late_library.h"

#include <pthread.h>

static const char *const FILES[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", NULL};

static pthread_once_t once = PTHREAD_ONCE_INIT;
static hn_osmesa functions; // written once, by load()
static hn_late_library library = {.name = "OSMesa", .package = "libosmesa6", .files = FILES};

static void load(void) {
#define FIND(name) &&hn_late_library_find(&library, #name, &functions.name)
    (void)(hn_late_library_open(&library) HN_OSMESA_LIST(FIND));
#undef FIND
}

const hn_osmesa *hn_osmesa_get(hn_diag *diag) {
    pthread_once(&once, load);
    const hn_status status = hn_late_library_check(&library, "no picture can be made", diag);
    return status == HN_OK ? &functions : NULL;
}

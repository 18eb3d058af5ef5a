// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/osmesa.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static const char *const NAMES[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};

static pthread_once_t once = PTHREAD_ONCE_INIT;
static hn_osmesa functions; // written once, by load()
static char missing[200];   // what stood in the way, "" when all is there

/// Finds one function. A conversion from void * is not ISO C; POSIX promises equal representations.
static bool find(void *library, const char *name, void *out) {
    void *const symbol = dlsym(library, name);
    memcpy(out, &symbol, sizeof symbol);
    if (!symbol) {
        snprintf(missing, sizeof missing, "OSMesa has no function %s", name);
    }
    return symbol != NULL;
}

static void load(void) {
    void *library = NULL;
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES && !library; i++) {
        library = dlopen(NAMES[i], RTLD_NOW | RTLD_LOCAL);
    }
    if (!library) {
        const char *why = dlerror();
        snprintf(missing, sizeof missing, "OSMesa cannot be loaded (%.120s)", why ? why : "");
        return;
    }

#define FIND(name) &&find(library, #name, &functions.name)
    const bool all = true HN_OSMESA_LIST(FIND);
#undef FIND
    HN_ASSERT(all == (missing[0] == '\0'));
}

const hn_osmesa *hn_osmesa_get(hn_diag *diag) {
    pthread_once(&once, load);
    if (missing[0]) {
        hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "install libosmesa6",
                    "%s, so no picture can be made", missing);
        return NULL;
    }
    return &functions;
}

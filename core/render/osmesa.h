// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_OSMESA_H
#define HN_RENDER_OSMESA_H
// OSMesa, loaded when the first picture is painted and kept. Linked in the usual way it would bring
// LLVM into every start of the program: 30 ms and 50 MB for commands that paint nothing.

#include "base/diag.h"

#include <GL/osmesa.h>
#include <stdbool.h>

/// The functions that painting needs; the names are theirs.
#define HN_OSMESA_LIST(X)     \
    X(OSMesaCreateContextExt) \
    X(OSMesaDestroyContext)   \
    X(OSMesaMakeCurrent)      \
    X(OSMesaPixelStore)       \
    X(glBlendFunc)            \
    X(glClear)                \
    X(glClearColor)           \
    X(glColor4f)              \
    X(glDisable)              \
    X(glDrawArrays)           \
    X(glEnable)               \
    X(glEnableClientState)    \
    X(glFinish)               \
    X(glGetError)             \
    X(glLoadIdentity)         \
    X(glMatrixMode)           \
    X(glOrtho)                \
    X(glScissor)              \
    X(glStencilFunc)          \
    X(glStencilOp)            \
    X(glVertexPointer)        \
    X(glViewport)

typedef struct hn_osmesa {
#define HN_OSMESA_MEMBER(name) __typeof__(name) *name;
    HN_OSMESA_LIST(HN_OSMESA_MEMBER)
#undef HN_OSMESA_MEMBER
} hn_osmesa;

/// Returns the functions, loaded once for the process; safe to call from several threads.
/// NULL where the library or one of its functions is missing: `diag` (may be NULL) then says what,
/// with HN_ERR_UNSUPPORTED.
const hn_osmesa *hn_osmesa_get(hn_diag *diag);
#endif

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_RENDER_SNAPSHOT_SHEET_H
#define HN_RENDER_SNAPSHOT_SHEET_H
// The sheet of a snapshot: where drawing, inset and legend go, and how metres become pixels. Inside
// render/ only.

#include "base/units.h"
#include "render/snapshot.h"

#include <stdbool.h>

typedef struct hn_box {
    double x, y, width, height; ///< [px], upper left corner
} hn_box;

/// The words of the inset have strips of their own, above and below the glass [letters].
enum { HN_INSET_STRIP = 2 };

/// The unit of lengths: one for the whole picture, or for each the one that suits.
typedef enum hn_length_unit { HN_UNIT_ANY, HN_UNIT_M, HN_UNIT_MM } hn_length_unit;

/// A tear at a cut joint in one pose.
typedef struct hn_tear {
    int pose, index; ///< index into drawing->tears; pose -1: there is none
    double gap;      ///< [m]
} hn_tear;

/// The layout of a sheet. Made once from sizes and views, then only read.
/// A shape is drawn at most so many times: a spring once itself, and once as the pins at its ends.
enum { HN_SHAPE_ORDERS = 5 };

typedef struct hn_sheet {
    int width, height;
    double line; ///< width of an outline [px]
    double font; ///< body text [px]
    hn_box drawing, inset, legend;
    double scale;     ///< [px/m]
    double origin[2]; ///< pixel of the world's origin
    double bar;       ///< width of a bar whose scene says nothing [px]
    hn_view look;
    int in_space; ///< not seen from the front: what is nearer covers what is farther
    /// a mechanism in a plane of constant z that is not seen from the front: `plane` is how a
    /// length of 1 along world x and y is seen [px right and down]
    bool is_slanted;
    double plane[2][2];
    int *shapes;    ///< scratch: numbers of the shapes of a drawing, in the order they are painted
    double *depth;  ///< scratch: per shape, towards the viewer [m]
    double view[4]; ///< right0, right1, up0, up1 shown [m]
    int selected;   ///< index of the opaque pose
    hn_tear widest; ///< shown in the inset
    double glass;   ///< the height of what is magnified [px]
    double magnification; ///< of the inset against the drawing
    bool is_closed;       ///< even the widest tear is within rounding
    double scale_bar;     ///< [m]
    hn_length_unit unit;  ///< of all lengths in the picture
} hn_sheet;

/// The larger of the width and the height that the view takes on the sheet [px].
double hn_sheet_mechanism(const hn_sheet *s);
/// Writes a length in the unit of the sheet, with as many significant digits.
void hn_sheet_length(const hn_sheet *s, double metres, int digits, char out[HN_SI_TEXT]);
/// Makes the inset lower, as far as it can be read, so that the legend has `wanted` [px].
void hn_sheet_make_room(hn_sheet *s, double wanted);

/// Finds boxes, view and scale for the poses. `shapes` and `depth` stay NULL: the caller provides
/// them.
/// Fails: HN_ERR_INPUT, when no pose has finite points.
HN_MUST_CHECK hn_status hn_sheet_make(hn_sheet *s, int width, int height, const hn_drawing *d,
                                      const hn_snapshot_pose *poses, int n_poses,
                                      const hn_snapshot_opts *opts, hn_diag *diag);

/// Pixel of a place in the world [m].
void hn_sheet_pixel(const hn_sheet *s, const double *world, double out[2]);
/// Pixel of a place given along right and up [m].
void hn_sheet_place(const hn_sheet *s, const double plane[2], double out[2]);
/// 1 if every point the pose needs is finite.
bool hn_pose_is_drawable(const hn_drawing *drawing, const hn_snapshot_pose *pose);
double hn_tear_gap(const hn_drawing *drawing, const hn_snapshot_pose *pose, int tear);
/// Draws the line in the slot's dash; `scale` stretches the dash with thicker lines.
hn_stroke hn_slot_stroke(hn_theme theme, int slot, double width);
/// The line of the path of traced point k: each has a dash of its own.
hn_stroke hn_trace_stroke(hn_theme theme, int slot, double width, int k);
/// `colour` laid over the paper with this share.
uint32_t hn_tint(hn_theme theme, uint32_t colour, double share);

#endif

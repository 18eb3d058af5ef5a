// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_SCENE_FILES_H
#define HN_HTTP_SCENE_FILES_H
// Scenes as documents: the file of a shipped scene, the schema of the format, models of other
// programs read into a scene; and the pictures of a lesson.

struct hn_request;

/// The file of a shipped scene, as it was written.
void hn_handle_scene_document(struct hn_request *r);
/// The JSON schema of scene files.
void hn_handle_scene_schema(struct hn_request *r);
/// MJCF or URDF as text: the scene, and a note for everything of the file that is not in it.
void hn_handle_import(struct hn_request *r);
/// A picture that a lesson shows: PNG or SVG.
void hn_handle_lesson_picture(struct hn_request *r);
#endif

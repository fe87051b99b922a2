/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <epoxy/gl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "view/gl_bodies.h"
#include "view/gl_program.h"
#include "view/gl_shaders.h"
#include "view/gl_view.h"
#include "view/kept_poses.h"

enum { GRAIN = 256, OCTAVES = 4, VARIANTS = 16, TAPS_MAX = 32 };
enum { HAS_SHADOW = 1, HAS_OCCLUSION = 2, HAS_WAVES = 4, HAS_WATER = 8 };
enum { UNIT_SHADE = 2, UNIT_GRAIN = 3, UNIT_WAVES = 4, UNIT_OCCLUSION = 1 };
/* Golden angle [rad]. */
#define SPIRAL_TURN 2.39996f
/* Ambient occlusion that reaches less far than this only darkens a picture evenly, and is left out [pixels].
 * */
#define OCCLUSION_PIXELS 1.5
/* Of a film the maps of shadow and occlusion are kept until a body has moved by half a texel of them: half a
 * pixel of the lamp's view; one of the picture, since occlusion has half its size. */
#define SHADOW_STEP 0.5
#define OCCLUSION_STEP 1.0
/* Of the layers above and below the water, in units of the scene. */
#define LAYER_LAP 1e-4f
/* Radius of a scene whose noise and haze have the unit 1 m. */
#define UNIT_RADIUS 35.0

/* The programs of one set of passes. */
struct variant {
    GLuint mesh, point, square, back;
};

struct fl_gl_view {
    fl_gl_bodies *bodies;
    struct variant variant[VARIANTS];
    GLuint mesh_depth, point_depth, square_depth, tube, occlusion, blur, copy;
    int occlusion_taps;
    GLuint grain, nothing, waves, overlay;
    int overlay_w, overlay_h;
    fl_gl_quality size; /* of the targets below; w = 0: none */
    int W, H;           /* pixels drawn */
    GLuint colour, depth, frame, back, back_frame, occ[2], occ_frame[2], occ_depth, occ_depth_frame, shade,
        shade_frame;
    GLuint pixels[2];
    size_t pixel_bytes;
    /* What the kept background was drawn with. */
    int back_kept, back_variant;
    fl_eye back_eye;
    fl_look back_look;
    fl_kept_poses shade_kept, occ_kept; /* what the maps were drawn with */
    /* Of the picture under way. */
    fl_eye eye;
    fl_mat4 to_shade;
    float sun[3], unit, reach;
    float cut[4];
};

/* --- noise -------------------------------------------------------------------------------------- */

static unsigned lattice(unsigned x, unsigned y, unsigned s)
{
    unsigned h = x * 0x9E3779B1u ^ y * 0x85EBCA77u ^ s * 0xC2B2AE3Du;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    h ^= h >> 15;
    return h >> 24;
}

/* Tileable noise: four octaves of a lattice, cubic between its points. */
static unsigned char grain_at(unsigned x, unsigned y, unsigned channel)
{
    float s = 0.0f, k = 0.5f;
    for (unsigned o = 0; o < OCTAVES; o++, k *= 0.5f) {
        const unsigned n = 8u << o, d = GRAIN / n, i = x / d, j = y / d, seed = channel * 9 + o;
        float u = (float)(x % d) / (float)d, v = (float)(y % d) / (float)d;
        u = u * u * (3 - 2 * u);
        v = v * v * (3 - 2 * v);
        const float a = (float)lattice(i, j, seed), b = (float)lattice((i + 1) % n, j, seed);
        const float p = (float)lattice(i, (j + 1) % n, seed),
                    q = (float)lattice((i + 1) % n, (j + 1) % n, seed);
        s += k * (a + u * (b - a) + v * (p - a + u * (a - b - p + q)));
    }
    return (unsigned char)s;
}

static int make_grain(fl_gl_view *g, fl_err *err)
{
    unsigned char *px = fl_alloc(GRAIN * GRAIN, 2, err);
    if (!px) return -1;
    for (unsigned y = 0; y < GRAIN; y++)
        for (unsigned x = 0; x < GRAIN; x++)
            for (unsigned c = 0; c < 2; c++) px[2 * (GRAIN * y + x) + c] = grain_at(x, y, c);
    glGenTextures(1, &g->grain);
    glBindTexture(GL_TEXTURE_2D, g->grain);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RG8, GRAIN, GRAIN, 0, GL_RG, GL_UNSIGNED_BYTE, px);
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    free(px);
    return 0;
}

/* --- programs and targets ----------------------------------------------------------------------- */

static GLuint build(const char *head, const char *vertex, const char *common, const char *pixel, fl_err *err)
{
    const char *const v[] = {head, vertex, NULL}, *const f[] = {head, common, pixel, NULL};
    return fl_gl_program(v, f, err);
}

/* One program, made when it is first needed. */
static int need_program(GLuint *program, int which, const char *vertex, const char *pixel, fl_err *err)
{
    char head[120];
    if (*program) return 0;
    snprintf(head, sizeof head, "#define COLOUR\n%s%s%s%s", which & HAS_WATER ? "#define WATER\n" : "",
             which & HAS_SHADOW ? "#define SHADOW\n" : "", which & HAS_OCCLUSION ? "#define OCCLUSION\n" : "",
             which & HAS_WAVES ? "#define WAVES\n" : "");
    *program = build(head, vertex, fl_glsl_common, pixel, err);
    return *program ? 0 : -1;
}

static int need_variant(fl_gl_view *g, int which, fl_err *err)
{
    const int dry = which & ~HAS_WATER;
    if (need_program(&g->variant[dry].mesh, dry, fl_glsl_mesh_vertex, fl_glsl_mesh_pixel, err)) return -1;
    struct variant *p = &g->variant[which];
    if (fl_gl_bodies_point_count(g->bodies) &&
        need_program(&p->point, which, fl_glsl_sphere_point, fl_glsl_sphere_pixel, err))
        return -1;
    if (fl_gl_bodies_square_count(g->bodies) &&
        need_program(&p->square, which, fl_glsl_sphere_quad, fl_glsl_sphere_pixel, err))
        return -1;
    return need_program(&p->mesh, which, fl_glsl_mesh_vertex, fl_glsl_mesh_pixel, err);
}

fl_gl_view *fl_gl_view_open(fl_err *err)
{
    fl_gl_view *g = fl_alloc(1, sizeof *g, err);
    if (!g) return NULL;
    g->bodies = fl_gl_bodies_open(err);
    if (!g->bodies || make_grain(g, err)) goto fail;
    glGenVertexArrays(1, &g->nothing);
    g->mesh_depth = build("", fl_glsl_mesh_vertex, "", fl_glsl_nothing_pixel, err);
    g->point_depth = g->mesh_depth ? build("", fl_glsl_sphere_point, "", fl_glsl_sphere_pixel, err) : 0;
    g->square_depth = g->point_depth ? build("", fl_glsl_sphere_quad, "", fl_glsl_sphere_pixel, err) : 0;
    g->tube = g->square_depth ? build("", fl_glsl_tube_vertex, "", fl_glsl_tube_pixel, err) : 0;
    g->blur = g->tube ? build("", fl_glsl_full_vertex, "", fl_glsl_blur_pixel, err) : 0;
    g->copy = g->blur ? build("", fl_glsl_full_vertex, "", fl_glsl_copy_pixel, err) : 0;
    if (!g->copy) goto fail;
    return g;
fail:
    fl_gl_view_close(g);
    return NULL;
}

static void drop_targets(fl_gl_view *g)
{
    const GLuint texture[] = {g->colour, g->depth, g->back, g->occ[0], g->occ[1], g->occ_depth, g->shade};
    const GLuint frame[] = {g->frame,        g->back_frame,      g->occ_frame[0],
                            g->occ_frame[1], g->occ_depth_frame, g->shade_frame};
    glDeleteTextures(7, texture);
    glDeleteFramebuffers(6, frame);
    g->colour = g->depth = g->back = g->occ[0] = g->occ[1] = g->occ_depth = g->shade = 0;
    g->frame = g->back_frame = g->occ_frame[0] = g->occ_frame[1] = g->occ_depth_frame = g->shade_frame = 0;
    g->size.w = 0;
    g->back_kept = 0;
    fl_kept_poses_drop(&g->shade_kept);
    fl_kept_poses_drop(&g->occ_kept);
}

static int make_shade(fl_gl_view *g, int side, fl_err *err)
{
    static const float light[4] = {1, 1, 1, 1}; /* beyond the map there is light */
    g->shade = fl_gl_texture(FL_GL_DEPTH, side, side, 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, light);
    g->shade_frame = fl_gl_target(0, g->shade, err);
    return g->shade_frame ? 0 : -1;
}

static int need_targets(fl_gl_view *g, fl_gl_quality q, fl_err *err)
{
    GLint most = 0;
    if (g->size.w == q.w && g->size.h == q.h && g->size.samples == q.samples && g->size.shadow == q.shadow &&
        !g->size.occlusion == !q.occlusion)
        return 0;
    drop_targets(g);
    g->W = q.w * q.samples;
    g->H = q.h * q.samples;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (g->W > most || g->H > most)
        return fl_fail(err, FL_SYSTEM,
                       "a picture of %d x %d with %d x %d samples is beyond what the driver can draw, %d",
                       q.w, q.h, q.samples, q.samples, most);
    g->colour = fl_gl_texture(FL_GL_COLOUR, g->W, g->H, 1);
    g->depth = fl_gl_texture(FL_GL_DEPTH, g->W, g->H, 0);
    g->frame = fl_gl_target(g->colour, g->depth, err);
    g->back = fl_gl_texture(FL_GL_COLOUR, g->W, g->H, 0);
    g->back_frame = g->frame ? fl_gl_target(g->back, 0, err) : 0;
    if (!g->back_frame || (q.shadow && make_shade(g, q.shadow, err))) return -1;
    if (q.occlusion) {
        const int w = (q.w + 1) / 2, h = (q.h + 1) / 2;
        g->occ_depth = fl_gl_texture(FL_GL_DEPTH, w, h, 0);
        g->occ_depth_frame = fl_gl_target(0, g->occ_depth, err);
        for (int k = 0; k < 2; k++) {
            g->occ[k] = fl_gl_texture(FL_GL_GREY, w, h, 1);
            g->occ_frame[k] = g->occ_depth_frame ? fl_gl_target(g->occ[k], 0, err) : 0;
            if (!g->occ_frame[k]) return -1;
        }
    }
    g->size = q;
    return 0;
}

fl_gl_quality fl_gl_view_quality(const fl_look *l, int w, int h, int moving)
{
    fl_gl_quality q = {.w = w, .h = h};
    q.samples = moving == 2 ? 1 : l->picture.samples > 0 ? l->picture.samples : moving ? 1 : 2;
    q.shadow = l->light.shadow >= 0 ? l->light.shadow : moving ? 1024 : 4096;
    q.occlusion = moving == 2 ? 0 : l->light.occlusion >= 0 ? l->light.occlusion : moving ? 8 : 12;
    q.keep_back = moving != 0;
    q.keep_maps = moving == 1;
    return q;
}

/* --- passes ------------------------------------------------------------------------------------- */

static void set_common(fl_gl_view *g, GLuint p, const fl_look *l, const fl_view_frame *v, int which,
                       const fl_sea_surface *sea)
{
    float deep[3], backdrop[3], cap[3] = {0.78f, 0.52f, 0.36f};
    for (int k = 0; k < 3; k++) {
        deep[k] = (float)l->water.colour.c[k] / 255.0f;
        backdrop[k] = (float)l->background.colour.c[k] / 255.0f;
    }
    fl_gl_set_vec3(p, "sun", g->sun);
    fl_gl_set_vec3(p, "eye", g->eye.eye);
    fl_gl_set_vec3(p, "ahead", g->eye.ahead);
    fl_gl_set_int(p, "parallel", g->eye.parallel);
    fl_gl_set_float(p, "level", (float)(l->water.level - v->origin.z));
    fl_gl_set_float(p, "clearness", (float)l->water.opacity);
    fl_gl_set_float(p, "unit", g->unit);
    fl_gl_set_int(p, "water", l->water.shown);
    fl_gl_set_int(p, "plain", l->background.kind);
    fl_gl_set_vec3(p, "deep", deep);
    fl_gl_set_vec3(p, "backdrop", backdrop);
    fl_gl_set_vec3(p, "cap", cap);
    fl_gl_set_vec4(p, "cut", g->cut);
    fl_gl_bind(p, "grain", UNIT_GRAIN, g->grain);
    if (which & HAS_SHADOW) {
        fl_gl_bind(p, "shade", UNIT_SHADE, g->shade);
        fl_gl_set_matrix(p, "to_shade", &g->to_shade);
    }
    if (which & HAS_OCCLUSION) {
        fl_gl_bind(p, "occlusion", UNIT_OCCLUSION, g->occ[1]);
        fl_gl_set_vec2(p, "pixel", 1.0f / (float)g->W, 1.0f / (float)g->H);
    }
    if (which & HAS_WAVES) {
        const float place[3] = {sea->x0 - (float)v->origin.x, sea->y0 - (float)v->origin.y, 1.0f / sea->side};
        fl_gl_bind(p, "waves", UNIT_WAVES, g->waves);
        fl_gl_set_vec3(p, "wave_patch", place);
    }
    /* of spheres */
    fl_gl_set_matrix(p, "view", &g->eye.view);
    fl_gl_set_matrix(p, "projection", &g->eye.projection);
    fl_gl_set_matrix(p, "inverse_turn", &g->eye.inverse_turn);
    fl_gl_set_vec3(p, "place", g->eye.eye);
    fl_gl_set_matrix(p, "both", &g->eye.both);
}

static void draw_depth(fl_gl_view *g, const fl_mat4 *both, const fl_eye *eye, int w, int h, int ice,
                       int structure)
{
    glUseProgram(g->mesh_depth);
    fl_gl_set_matrix(g->mesh_depth, "both", both);
    fl_gl_set_vec4(g->mesh_depth, "cut", g->cut);
    fl_gl_set_vec2(g->mesh_depth, "layer", 0.0f, 1.0f);
    if (ice) fl_gl_bodies_meshes(g->bodies, g->mesh_depth, FL_GL_ICE, 1);
    if (structure) fl_gl_bodies_meshes(g->bodies, g->mesh_depth, FL_GL_STRUCTURE, 1);
    for (int k = 0; ice && k < 2; k++) {
        const GLuint p = k ? g->square_depth : g->point_depth;
        if ((k ? fl_gl_bodies_square_count(g->bodies) : fl_gl_bodies_point_count(g->bodies)) == 0) continue;
        glUseProgram(p);
        fl_gl_set_matrix(p, "view", &eye->view);
        fl_gl_set_matrix(p, "projection", &eye->projection);
        fl_gl_set_matrix(p, "inverse_turn", &eye->inverse_turn);
        fl_gl_set_vec3(p, "place", eye->eye);
        fl_gl_set_vec4(p, "cut", g->cut);
        fl_gl_set_int(p, "parallel", eye->parallel);
        fl_gl_set_vec2(p, "size", (float)w, (float)h);
        fl_gl_set_float(p, "height", (float)h);
        if (k) fl_gl_bodies_squares(g->bodies);
        else fl_gl_bodies_points(g->bodies);
    }
}

/* True if a map of a film still holds; otherwise what it is drawn with is kept.  -1 with FL_SYSTEM. */
static int is_map_kept(fl_kept_poses *k, const fl_view_frame *v, const fl_eye *eye, const fl_map_key *key,
                       fl_gl_quality q, double pixels, fl_err *err)
{
    if (!q.keep_maps) {
        fl_kept_poses_drop(k);
        return 0;
    }
    return fl_kept_poses_hold(k, v, eye, key, pixels) ? 1 : fl_kept_poses_take(k, v, eye, key, err);
}

static int pass_shadow(fl_gl_view *g, const fl_view_frame *v, const fl_camera *c, fl_gl_quality q,
                       const fl_map_key *key, fl_err *err)
{
    static const fl_mat4 to_texture = {{0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, 0.5f, 0.5f, 0.4994f, 1}};
    const double seen = 2.2 * c->distance * tan(0.5 * c->field) * fmax(1.0, (double)q.w / q.h);
    const int whole = seen >= v->radius;
    const double radius = whole ? v->radius : seen;
    const fl_vec3 centre = whole ? v->centre : c->at;
    const double a = atan2(g->sun[1], g->sun[0]), e = asin(g->sun[2]);
    const fl_camera lamp = {centre, a, e, 2.0 * radius, 2.0 * atan(0.5), 1};
    const fl_eye eye = fl_camera_eye(&lamp, q.shadow, q.shadow, centre, radius);
    const int kept = is_map_kept(&g->shade_kept, v, &eye, key, q, SHADOW_STEP, err);
    if (kept) return kept < 0 ? -1 : 0;
    g->to_shade = fl_mat4_mul(to_texture, eye.both);
    glBindFramebuffer(GL_FRAMEBUFFER, g->shade_frame);
    glViewport(0, 0, q.shadow, q.shadow);
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_depth(g, &eye.both, &eye, q.shadow, q.shadow, key->ice, key->structure);
    return 0;
}

static void draw_full(fl_gl_view *g)
{
    glBindVertexArray(g->nothing);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

static int pass_occlusion(fl_gl_view *g, const fl_view_frame *v, fl_gl_quality q, const fl_map_key *key,
                          fl_err *err)
{
    const int kept = is_map_kept(&g->occ_kept, v, &g->eye, key, q, OCCLUSION_STEP, err);
    const int w = (q.w + 1) / 2, h = (q.h + 1) / 2;
    float spiral[2 * TAPS_MAX];
    char head[40];
    if (kept) return kept < 0 ? -1 : 0;
    if (g->occlusion_taps != q.occlusion) {
        if (g->occlusion) glDeleteProgram(g->occlusion);
        snprintf(head, sizeof head, "#define TAPS %d\n", q.occlusion);
        g->occlusion = build(head, fl_glsl_full_vertex, "", fl_glsl_occlusion_pixel, err);
        if (!g->occlusion) return -1;
        g->occlusion_taps = q.occlusion;
    }
    for (int k = 0; k < q.occlusion; k++) {
        const float r = sqrtf(((float)k + 0.5f) / (float)q.occlusion);
        spiral[2 * k] = r * cosf(SPIRAL_TURN * (float)k);
        spiral[2 * k + 1] = r * sinf(SPIRAL_TURN * (float)k);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, g->occ_depth_frame);
    glViewport(0, 0, w, h);
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_depth(g, &g->eye.both, &g->eye, w, h, key->ice, key->structure);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    for (int k = 0; k < 2; k++) {
        const GLuint p = k ? g->blur : g->occlusion;
        glBindFramebuffer(GL_FRAMEBUFFER, g->occ_frame[k]);
        glUseProgram(p);
        fl_gl_bind(p, k ? "occlusion" : "depth", 0, k ? g->occ[0] : g->occ_depth);
        fl_gl_set_vec2(p, "size", (float)w, (float)h);
        if (!k) {
            fl_gl_set_matrix(p, "projection", &g->eye.projection);
            fl_gl_set_float(p, "reach", g->reach);
            glUniform2fv(glGetUniformLocation(p, "spiral"), q.occlusion, spiral);
        }
        draw_full(g);
    }
    return 0;
}

/* Water and sky where no body is. */
static int pass_back(fl_gl_view *g, const fl_view_frame *v, const fl_look *l, fl_gl_quality q, int which,
                     const fl_sea_surface *sea, fl_err *err)
{
    const int variant = (q.keep_back ? which & ~HAS_SHADOW : which) & ~(HAS_OCCLUSION | HAS_WATER);
    if (!q.keep_back || sea || !g->back_kept || variant != g->back_variant ||
        memcmp(&g->eye, &g->back_eye, sizeof g->eye) != 0 || memcmp(l, &g->back_look, sizeof *l) != 0) {
        if (need_program(&g->variant[variant].back, variant, fl_glsl_full_vertex, fl_glsl_back_pixel, err))
            return -1;
        const GLuint p = g->variant[variant].back;
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_CULL_FACE);
        glBindFramebuffer(GL_FRAMEBUFFER, g->back_frame);
        glViewport(0, 0, g->W, g->H);
        glUseProgram(p);
        set_common(g, p, l, v, variant, sea);
        draw_full(g);
        g->back_kept = 1;
        g->back_variant = variant;
        g->back_eye = g->eye;
        g->back_look = *l;
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, g->back_frame);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, g->frame);
    glBlitFramebuffer(0, 0, g->W, g->H, 0, 0, g->W, g->H, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, g->frame);
    glViewport(0, 0, g->W, g->H);
    glClear(GL_DEPTH_BUFFER_BIT);
    return 0;
}

/* Meshes of the ice or the structure, in two layers where the water is still: a processor that draws works
 * through the light under water for each pixel of a body, also above the water, where it counts for nothing.
 * The lower layer reaches a little into the upper, so that no gap shows between them. */
static void draw_meshes(fl_gl_view *g, const fl_view_frame *v, const fl_look *l, int which,
                        const fl_sea_surface *sea, enum fl_gl_what what, double opacity)
{
    const int layers = (which & HAS_WATER) && !sea && opacity >= 1.0 ? 2 : 1;
    const float level = (float)(l->water.level - v->origin.z), lap = LAYER_LAP * g->unit;
    glEnable(GL_CLIP_DISTANCE1); /* Mesa 22 clips by a distance that is written also where it is disabled */
    for (int k = 0; k < layers; k++) {
        const int wet = layers == 1 || k == 1;
        const GLuint p = g->variant[wet ? which : which & ~HAS_WATER].mesh;
        glUseProgram(p);
        set_common(g, p, l, v, which, sea);
        fl_gl_set_float(p, "opacity", (float)opacity);
        if (layers == 1) fl_gl_set_vec2(p, "layer", 0.0f, 1.0f);
        else fl_gl_set_vec2(p, "layer", wet ? -1.0f : 1.0f, wet ? level + lap : -level);
        fl_gl_bodies_meshes(g->bodies, p, what, 0);
    }
    glDisable(GL_CLIP_DISTANCE1);
}

static void draw_ice(fl_gl_view *g, const fl_view_frame *v, const fl_look *l, int which,
                     const fl_sea_surface *sea)
{
    const struct variant *p = &g->variant[which];
    draw_meshes(g, v, l, which, sea, FL_GL_ICE, l->ice.opacity);
    for (int k = 0; k < 2; k++) {
        const GLuint s = k ? p->square : p->point;
        if ((k ? fl_gl_bodies_square_count(g->bodies) : fl_gl_bodies_point_count(g->bodies)) == 0) continue;
        glUseProgram(s);
        set_common(g, s, l, v, which, sea);
        fl_gl_set_float(s, "opacity", (float)l->ice.opacity);
        fl_gl_set_vec2(s, "size", (float)g->W, (float)g->H);
        fl_gl_set_float(s, "height", (float)g->H);
        if (k) fl_gl_bodies_squares(g->bodies);
        else fl_gl_bodies_points(g->bodies);
    }
}

static void draw_structure(fl_gl_view *g, const fl_view_frame *v, const fl_look *l, int which,
                           const fl_sea_surface *sea)
{
    draw_meshes(g, v, l, which, sea, FL_GL_STRUCTURE, l->structure.opacity);
}

/* What is transparent shows its nearest layer alone: its depth first, then its colour where the depth is
 * equal. */
static void draw_transparent(fl_gl_view *g, const fl_view_frame *v, const fl_look *l, int which,
                             const fl_sea_surface *sea, int ice)
{
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    if (ice) draw_ice(g, v, l, which, sea);
    else draw_structure(g, v, l, which, sea);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    if (ice) draw_ice(g, v, l, which, sea);
    else draw_structure(g, v, l, which, sea);
    glDisable(GL_BLEND);
}

static void pass_tubes(fl_gl_view *g, const fl_view_frame *v, const fl_look *l)
{
    float deep[3];
    if (!v->tubes) return;
    glClear(GL_DEPTH_BUFFER_BIT); /* they are seen through the ice */
    glDisable(GL_CULL_FACE);
    glUseProgram(g->tube);
    fl_gl_set_matrix(g->tube, "both", &g->eye.both);
    fl_gl_set_vec3(g->tube, "sun", g->sun);
    fl_gl_set_vec3(g->tube, "eye", g->eye.eye);
    fl_gl_set_vec3(g->tube, "ahead", g->eye.ahead);
    fl_gl_set_int(g->tube, "parallel", g->eye.parallel);
    for (int k = 0; k < 3; k++) deep[k] = (float)l->water.colour.c[k] / 255.0f;
    fl_gl_set_vec3(g->tube, "deep", deep);
    fl_gl_set_float(g->tube, "level", (float)(l->water.level - v->origin.z));
    fl_gl_set_float(g->tube, "clearness", (float)l->water.opacity);
    fl_gl_set_int(g->tube, "water", l->water.shown);
    fl_gl_bodies_tubes(g->bodies);
}

static void send_waves(fl_gl_view *g, const fl_sea_surface *sea)
{
    if (!g->waves) g->waves = fl_gl_texture(FL_GL_FLOAT1, FL_SEA_SIDE, FL_SEA_SIDE, 1);
    glBindTexture(GL_TEXTURE_2D, g->waves);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, FL_SEA_SIDE, FL_SEA_SIDE, GL_RED, GL_FLOAT, sea->height);
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Half of the median size of the bodies; of a bare structure a share of its own. */
static float occlusion_reach(const fl_view_frame *v)
{
    enum { SAMPLE = 501 };
    float r[SAMPLE];
    int32_t n = 0;
    for (int32_t k = 0; k < v->rows && n < SAMPLE; k += v->rows / SAMPLE + 1) r[n++] = v->reach[k];
    if (n == 0) return (float)(0.05 * v->radius);
    qsort(r, (size_t)n, sizeof *r, compare_floats);
    return 0.55f * r[n / 2];
}

static void set_light_and_cut(fl_gl_view *g, const fl_view_frame *v, const fl_look *l)
{
    const double a = fl_radians(l->light.azimuth), e = fl_radians(l->light.elevation);
    const double origin[3] = {v->origin.x, v->origin.y, v->origin.z};
    g->sun[0] = (float)(cos(e) * cos(a));
    g->sun[1] = (float)(cos(e) * sin(a));
    g->sun[2] = (float)sin(e);
    g->unit = (float)(v->radius / UNIT_RADIUS);
    g->reach = occlusion_reach(v);
    for (int k = 0; k < 3; k++) g->cut[k] = 0.0f;
    g->cut[3] = 1.0f;
    if (l->cut.axis) {
        const float side = l->cut.side ? 1.0f : -1.0f;
        g->cut[l->cut.axis - 1] = side;
        g->cut[3] = -side * (float)(l->cut.at - origin[l->cut.axis - 1]);
    }
}

int fl_gl_view_draw(fl_gl_view *g, const fl_view_frame *v, const fl_look *l, const fl_camera *camera,
                    fl_gl_quality q, const fl_sea_surface *sea, fl_err *err)
{
    fl_camera c = *camera;
    const int ice = l->ice.opacity > 0.0, structure = l->structure.opacity > 0.0;
    fl_map_key key = {l->ice.opacity >= 0.5, l->structure.opacity >= 0.5, {0}};
    c.at = v3_sub(c.at, v->origin);
    set_light_and_cut(g, v, l);
    g->eye = fl_camera_eye(&c, q.w, q.h, v->centre, v->radius);
    if (g->reach < OCCLUSION_PIXELS * g->eye.pixel * (c.parallel ? 1.0 : c.distance)) q.occlusion = 0;
    if (need_targets(g, q, err)) return -1;
    const int which = (q.shadow ? HAS_SHADOW : 0) | (q.occlusion ? HAS_OCCLUSION : 0) |
                      (sea ? HAS_WAVES : 0) | (l->water.shown ? HAS_WATER : 0);
    if (fl_gl_bodies_load(g->bodies, v, &g->eye, err) || need_variant(g, which, err)) return -1;
    if (sea) send_waves(g, sea);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    if (l->cut.axis) glEnable(GL_CLIP_DISTANCE0);
    else {
        glDisable(GL_CLIP_DISTANCE0);
        glEnable(GL_CULL_FACE);
    }
    memcpy(key.cut, g->cut, sizeof key.cut);
    if (q.shadow && pass_shadow(g, v, &c, q, &key, err)) return -1;
    if (q.occlusion && pass_occlusion(g, v, q, &key, err)) return -1;
    if (pass_back(g, v, l, q, which, sea, err)) return -1;
    glEnable(GL_DEPTH_TEST);
    if (!l->cut.axis) glEnable(GL_CULL_FACE);
    if (l->structure.opacity >= 1.0) draw_structure(g, v, l, which, sea);
    if (l->ice.opacity >= 1.0) draw_ice(g, v, l, which, sea);
    else if (ice) draw_transparent(g, v, l, which, sea, 1);
    if (structure && l->structure.opacity < 1.0) draw_transparent(g, v, l, which, sea, 0);
    pass_tubes(g, v, l);
    glDisable(GL_CLIP_DISTANCE0);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    const GLenum wrong = glGetError();
    return wrong == GL_NO_ERROR ? 0 : fl_fail(err, FL_SYSTEM, "OpenGL reports error 0x%x", wrong);
}

/* --- reading and showing ------------------------------------------------------------------------ */

/* Means of samples x samples pixels, rows swapped. */
static void reduce_samples(const unsigned char *from, int W, int s, fl_picture *p)
{
    const int n = s * s;
    for (int y = 0; y < p->h && s == 1; y++)
        memcpy(p->px + 4 * (size_t)y * (size_t)p->w, from + 4 * (size_t)(p->h - 1 - y) * (size_t)W,
               4 * (size_t)p->w);
    for (int y = 0; y < p->h && s > 1; y++)
        for (int x = 0; x < p->w; x++) {
            int sum[3] = {0};
            for (int j = 0; j < s; j++) {
                const unsigned char *a =
                    from + 4 * ((size_t)((p->h - 1 - y) * s + j) * (size_t)W + (size_t)(x * s));
                for (int i = 0; i < s; i++)
                    for (int k = 0; k < 3; k++) sum[k] += a[4 * i + k];
            }
            unsigned char *to = p->px + 4 * ((size_t)y * (size_t)p->w + (size_t)x);
            for (int k = 0; k < 3; k++) to[k] = (unsigned char)((sum[k] + n / 2) / n);
            to[3] = 255;
        }
}

int fl_gl_view_read(fl_gl_view *g, fl_picture *p, fl_err *err)
{
    unsigned char *all = fl_alloc((int64_t)g->W * g->H, 4, err);
    if (!all) return -1;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, g->frame);
    glReadPixels(0, 0, g->W, g->H, GL_RGBA, GL_UNSIGNED_BYTE, all);
    reduce_samples(all, g->W, g->size.samples, p);
    free(all);
    return 0;
}

void fl_gl_view_start_read(fl_gl_view *g, int which)
{
    const size_t bytes = 4 * (size_t)g->W * (size_t)g->H;
    if (bytes != g->pixel_bytes) {
        if (!g->pixels[0]) glGenBuffers(2, g->pixels);
        for (int k = 0; k < 2; k++) {
            glBindBuffer(GL_PIXEL_PACK_BUFFER, g->pixels[k]);
            glBufferData(GL_PIXEL_PACK_BUFFER, (GLsizeiptr)bytes, NULL, GL_STREAM_READ);
        }
        g->pixel_bytes = bytes;
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, g->frame);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, g->pixels[which]);
    glReadPixels(0, 0, g->W, g->H, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glFlush();
}

void fl_gl_view_end_read(fl_gl_view *g, int which, fl_picture *p)
{
    glBindBuffer(GL_PIXEL_PACK_BUFFER, g->pixels[which]);
    const unsigned char *all =
        glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, (GLsizeiptr)g->pixel_bytes, GL_MAP_READ_BIT);
    if (all) reduce_samples(all, g->W, g->size.samples, p);
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void fl_gl_view_show(fl_gl_view *g, int w, int h, int bottom, const fl_picture *overlay)
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, g->frame);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, g->W, g->H, 0, bottom, w, h, GL_COLOR_BUFFER_BIT,
                      g->W == w ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!overlay) return;
    if (!g->overlay || g->overlay_w != overlay->w || g->overlay_h != overlay->h) {
        if (g->overlay) glDeleteTextures(1, &g->overlay);
        g->overlay = fl_gl_texture(FL_GL_COLOUR, overlay->w, overlay->h, 0);
        g->overlay_w = overlay->w;
        g->overlay_h = overlay->h;
    }
    glViewport(0, 0, w, h);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glUseProgram(g->copy);
    fl_gl_bind(g->copy, "colour", 0, g->overlay);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, overlay->w, overlay->h, GL_RGBA, GL_UNSIGNED_BYTE, overlay->px);
    draw_full(g);
    glDisable(GL_BLEND);
}

void fl_gl_view_close(fl_gl_view *g)
{
    if (!g) return;
    drop_targets(g);
    for (int k = 0; k < VARIANTS; k++) {
        const struct variant *p = &g->variant[k];
        glDeleteProgram(p->mesh);
        glDeleteProgram(p->point);
        glDeleteProgram(p->square);
        glDeleteProgram(p->back);
    }
    const GLuint program[] = {g->mesh_depth, g->point_depth, g->square_depth, g->tube,
                              g->occlusion,  g->blur,        g->copy};
    for (int k = 0; k < 7; k++) glDeleteProgram(program[k]);
    const GLuint texture[] = {g->grain, g->waves, g->overlay};
    glDeleteTextures(3, texture);
    glDeleteBuffers(2, g->pixels);
    glDeleteVertexArrays(1, &g->nothing);
    fl_gl_bodies_close(g->bodies);
    fl_kept_poses_free(&g->shade_kept);
    fl_kept_poses_free(&g->occ_kept);
    free(g);
}

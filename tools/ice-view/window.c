/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "window.h"
#include <SDL2/SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/pi.h"
#include "base/stream.h"
#include "panel.h"
#include "shot.h"
#include "view/film.h"
#include "view/gl_view.h"

enum { FRAME_MS = 16, SETTLE_MS = 200, FOLLOW_MS = 1000, CLICK_PIXELS = 4, FILM_FPS = 25, NOTE_LEN = 200 };
#define SPIN_SPEED 12.0 /* [deg/s] */

struct window {
    SDL_Window *window;
    SDL_GLContext context;
    struct subject *s;
    const struct options *o;
    fl_look look;
    fl_gl_view *gl;
    fl_picture overlay, seen;
    struct panel panel;
    int w, h;
    double t, rate; /* [s]; seconds of the run for a second */
    int playing, backward, ended, dirty, range_due, spinning, help;
    uint32_t last, moved_at; /* [ms] */
    uint32_t followed_at;
    int down_x, down_y, turning, shifting;
    char note[NOTE_LEN];
    int32_t picked;
    fl_film film;
    int filming, film_w, film_h, pictures, films;
    char film_path[64];
};

static const char *const HELP[] = {"blank play, pause     left right one frame     home end",
                                   "r direction     + - speed     drag the bar of time",
                                   "left button turn     right move     wheel nearer, farther",
                                   "1 oblique  2 plan  3 side  4 drift  5 front  o parallel  s spin",
                                   "c colour  m map  w water  t transparent  l curve  b tubes",
                                   "x cut  [ ] move it     p picture  v video  k save look  q end",
                                   NULL};

/* --- opening ------------------------------------------------------------------------------------ */

static int open_window(struct window *v, fl_err *err)
{
    const char *driver;
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        return fl_fail(err, FL_SYSTEM, "no window: %s; -o FILE.png and --movie need none", SDL_GetError());
    driver = SDL_GetCurrentVideoDriver();
    if (!driver || strcmp(driver, "offscreen") == 0 || strcmp(driver, "dummy") == 0)
        return fl_fail(err, FL_SYSTEM, "no window: there is no display; -o FILE.png and --movie need none");
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
    v->window = SDL_CreateWindow("ice-view", SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED,
                                 v->look.picture.width, v->look.picture.height,
                                 SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    v->context = v->window ? SDL_GL_CreateContext(v->window) : NULL;
    if (!v->context) return fl_fail(err, FL_SYSTEM, "no window: OpenGL 3.3 is missing: %s", SDL_GetError());
    SDL_GL_SetSwapInterval(1);
    v->gl = fl_gl_view_open(err);
    return v->gl ? 0 : -1;
}

static void close_window(struct window *v)
{
    fl_gl_view_close(v->gl);
    fl_film_abort(&v->film);
    fl_picture_free(&v->overlay);
    fl_picture_free(&v->seen);
    if (v->context) SDL_GL_DeleteContext(v->context);
    if (v->window) SDL_DestroyWindow(v->window);
    SDL_Quit();
}

/* What is drawn above the panel and the curve. */
static int strip_of(const struct window *v)
{
    const fl_picture p = {NULL, v->w, v->h};
    return subject_strip(v->s, &v->look, v->w, v->h) + panel_height(&p);
}

static int resize(struct window *v, fl_err *err)
{
    int w, h;
    SDL_GL_GetDrawableSize(v->window, &w, &h);
    if (w == v->w && h == v->h && v->overlay.px) return 0;
    v->w = w > 16 ? w : 16;
    v->h = h > 160 ? h : 160;
    fl_picture_free(&v->overlay);
    v->dirty = 1;
    return fl_picture_make(&v->overlay, v->w, v->h, err);
}

/* The camera's `auto` becomes numbers, which keys and mouse then change. */
static void fix_camera(struct window *v)
{
    const double aspect = (double)v->w / (v->h - strip_of(v));
    const fl_camera c = subject_camera(v->s, &v->look, aspect, 0.0);
    v->look.view.distance = c.distance;
    v->look.view.at_x = c.at.x;
    v->look.view.at_y = c.at.y;
    v->look.view.at_z = c.at.z;
}

static void standard_view(struct window *v, double azimuth, double elevation, int parallel)
{
    v->look.view.azimuth = azimuth;
    v->look.view.elevation = elevation;
    v->look.view.parallel = parallel;
    v->look.view.distance = v->look.view.at_x = v->look.view.at_y = v->look.view.at_z = NAN;
    fl_err lost = {0};
    subject_fit_now(v->s, &lost);
    fix_camera(v);
}

/* --- actions ------------------------------------------------------------------------------------ */

static void show_note(struct window *v, const char *text)
{
    snprintf(v->note, sizeof v->note, "%s", text);
    v->picked = -1;
}

static void step_frame(struct window *v, int by)
{
    const fl_frame_data *d = v->s->play.data;
    if (!v->s->file) return;
    int32_t k = fl_frame_data_at(d, v->t * (1 + 1e-12) + 1e-12);
    if (by < 0 && v->t > d->frame[k].t * (1 + 1e-9) + 1e-9) k++; /* between frames: back to the one before */
    k += by;
    k = k < 0 ? 0 : k >= d->frames ? d->frames - 1 : k;
    v->t = d->frame[k].t;
    v->playing = 0;
}

static void next_colour(struct window *v)
{
    const struct options *o = v->o;
    int by = v->look.colour.by;
    do by = (by + 1) % FL_BYS;
    while ((by == FL_BY_FORCE && !o->contacts) || (by == FL_BY_DAMAGE && !o->bonds) ||
           (by == FL_BY_GROUP && !o->ice) ||
           (by == FL_BY_COLUMN && (!o->table || !v->look.colour.column[0])) || by == FL_BY_ONE);
    v->look.colour.by = by;
    v->look.colour.from = v->look.colour.to = NAN;
    v->range_due = 1;
}

static void save_settings(struct window *v)
{
    fl_err lost = {0};
    fl_out out = {0};
    const char *path = v->o->save_look ? v->o->save_look : "ice-view.look";
    char text[NOTE_LEN];
    v->look.picture.width = v->w / 2 * 2;
    v->look.picture.height = v->h / 2 * 2;
    if (fl_out_open(&out, path, 0, &lost) == 0) {
        fl_look_write(out.f, &v->look);
        fl_out_close(&out, &lost);
    }
    snprintf(text, sizeof text, "%.190s", lost.code ? lost.text : path);
    show_note(v, text);
}

/* A name that is not taken: ice-view-N.png. */
static void free_name(char name[64], int *number, const char *ending)
{
    do snprintf(name, 64, "ice-view-%d.%s", ++*number, ending);
    while (access(name, F_OK) == 0);
}

/* What is seen without the panel, in the quality of a picture, with bar, time and curve. */
static void save_picture(struct window *v)
{
    fl_err lost = {0};
    fl_picture p = {0}, whole = {0};
    char name[64], text[NOTE_LEN];
    const int strip = subject_strip(v->s, &v->look, v->w, v->h), h = v->h - strip;
    const fl_gl_quality q = fl_gl_view_quality(&v->look, v->w, h, 0);
    const fl_camera c = subject_camera(v->s, &v->look, (double)v->w / h, 0.0);
    free_name(name, &v->pictures, "png");
    if (fl_picture_make(&p, v->w, h, &lost) == 0 && fl_picture_make(&whole, v->w, v->h, &lost) == 0 &&
        fl_gl_view_draw(v->gl, &v->s->shown, &v->look, &c, q, v->s->sea.height ? &v->s->sea : NULL, &lost) ==
            0 &&
        fl_gl_view_read(v->gl, &p, &lost) == 0) {
        memcpy(whole.px, p.px, 4 * (size_t)v->w * (size_t)h);
        subject_legend(v->s, &v->look, subject_time(v->s), &whole);
        shot_write(name, &whole, &lost);
    }
    fl_picture_free(&p);
    fl_picture_free(&whole);
    snprintf(text, sizeof text, "%.190s", lost.code ? lost.text : name);
    show_note(v, text);
}

static void toggle_film(struct window *v)
{
    fl_err lost = {0};
    char text[NOTE_LEN];
    if (v->filming) {
        v->filming = 0;
        fl_film_close(&v->film, &lost);
        snprintf(text, sizeof text, "%.190s", lost.code ? lost.text : v->film_path);
        show_note(v, text);
        return;
    }
    free_name(v->film_path, &v->films, "mp4");
    v->film_w = v->w / 2 * 2;
    v->film_h = (v->h - strip_of(v)) / 2 * 2;
    if (fl_film_open(&v->film, v->film_path, v->film_w, v->film_h, FILM_FPS, &lost) == 0) {
        v->filming = 1;
        show_note(v, "recording");
    } else {
        snprintf(text, sizeof text, "%.190s", lost.text);
        show_note(v, text);
    }
}

static void on_key(struct window *v, SDL_Keycode key)
{
    fl_look *l = &v->look;
    const double near = v->s->shown.radius;
    char text[NOTE_LEN];
    v->dirty = 1;
    switch (key) {
    case SDLK_SPACE: v->playing = !v->playing; break;
    case SDLK_LEFT: step_frame(v, -1); break;
    case SDLK_RIGHT: step_frame(v, 1); break;
    case SDLK_HOME: v->t = fl_playback_start(&v->s->play); break;
    case SDLK_END: v->t = fl_playback_end(&v->s->play); break;
    case SDLK_r: v->backward = !v->backward; break;
    case SDLK_PLUS:
    case SDLK_EQUALS:
    case SDLK_KP_PLUS: v->rate = fmin(64.0, 2.0 * v->rate); break;
    case SDLK_MINUS:
    case SDLK_KP_MINUS: v->rate = fmax(1.0 / 16, 0.5 * v->rate); break;
    case SDLK_1: standard_view(v, -125, 32, 0); break;
    case SDLK_2: standard_view(v, -90, 90, 1); break;
    case SDLK_3: standard_view(v, -90, 0, 1); break;
    case SDLK_4: standard_view(v, 180, 12, 0); break;
    case SDLK_5: standard_view(v, 0, 12, 0); break;
    case SDLK_o: l->view.parallel = !l->view.parallel; break;
    case SDLK_s: v->spinning = !v->spinning; break;
    case SDLK_c: next_colour(v); break;
    case SDLK_m: l->colour.map = (l->colour.map + 1) % FL_MAPS; break;
    case SDLK_w: l->water.shown = !l->water.shown; break;
    case SDLK_t: l->ice.opacity = l->ice.opacity < 1.0 ? 1.0 : 0.45; break;
    case SDLK_l: l->picture.curve = !l->picture.curve; break;
    case SDLK_b: l->contacts.shown = !l->contacts.shown; break;
    case SDLK_x:
        l->cut.axis = (l->cut.axis + 1) % 4;
        l->cut.at = l->cut.axis ? v3_at(v->s->shown.origin, l->cut.axis - 1) : 0.0;
        l->cut.side = 1;
        break;
    case SDLK_LEFTBRACKET: l->cut.at -= 0.02 * near; break;
    case SDLK_RIGHTBRACKET: l->cut.at += 0.02 * near; break;
    case SDLK_p: save_picture(v); break;
    case SDLK_v: toggle_film(v); break;
    case SDLK_k: save_settings(v); break;
    case SDLK_h: v->help = !v->help; break;
    case SDLK_ESCAPE:
    case SDLK_q: v->ended = 1; break;
    default: return;
    }
    if (v->o->verbose) {
        snprintf(text, sizeof text, "key %s, t = %g", SDL_GetKeyName(key), v->t);
        fprintf(stderr, "ice-view: %s\n", text);
    }
}

/* --- mouse -------------------------------------------------------------------------------------- */

static void on_drag(struct window *v, int dx, int dy)
{
    fl_look *l = &v->look;
    if (v->panel.taken) return;
    if (v->turning) {
        l->view.azimuth -= 0.35 * dx;
        l->view.elevation = fmax(-90.0, fmin(90.0, l->view.elevation + 0.35 * dy));
    } else if (v->shifting) {
        const double a = fl_radians(l->view.azimuth), e = fl_radians(l->view.elevation);
        const double pixel =
            2.0 * tan(0.5 * fl_radians(l->view.field)) * l->view.distance / (v->h - strip_of(v));
        const double up = pixel * dy, across = -pixel * dx, flat = fmax(0.2, fabs(sin(e)));
        l->view.at_x += across * -sin(a) - up / flat * cos(a);
        l->view.at_y += across * cos(a) - up / flat * sin(a);
    }
    v->moved_at = SDL_GetTicks();
    v->dirty = 1;
}

static void on_click(struct window *v, int x, int y)
{
    const int h = v->h - strip_of(v);
    fl_vec3 from, along;
    if (v->panel.taken || y >= h || abs(x - v->down_x) > CLICK_PIXELS || abs(y - v->down_y) > CLICK_PIXELS)
        return;
    const fl_camera c = subject_camera(v->s, &v->look, (double)v->w / h, 0.0);
    fl_camera_ray(&c, v->w, h, x, y, &from, &along);
    v->note[0] = '\0';
    v->picked = fl_view_frame_pick(&v->s->shown, from, along);
    if (v->picked >= 0) subject_tell(v->s, v->picked, v->note);
    if (v->o->verbose) fprintf(stderr, "ice-view: click %s\n", v->picked >= 0 ? v->note : "on no body");
    v->dirty = 1;
}

static void on_event(struct window *v, const SDL_Event *e)
{
    switch (e->type) {
    case SDL_QUIT: v->ended = 1; break;
    case SDL_KEYDOWN: on_key(v, e->key.keysym.sym); break;
    case SDL_WINDOWEVENT: v->dirty = 1; break;
    case SDL_MOUSEBUTTONDOWN:
        v->down_x = v->panel.x = e->button.x;
        v->down_y = v->panel.y = e->button.y;
        if (e->button.button == SDL_BUTTON_LEFT) {
            v->panel.pressed = v->panel.held = 1;
            v->turning = e->button.y < v->h - strip_of(v);
        } else v->shifting = 1;
        v->dirty = 1;
        break;
    case SDL_MOUSEBUTTONUP:
        if (e->button.button == SDL_BUTTON_LEFT) {
            if (v->turning) on_click(v, e->button.x, e->button.y);
            v->panel.held = v->turning = 0;
        } else v->shifting = 0;
        v->dirty = 1;
        break;
    case SDL_MOUSEMOTION:
        v->panel.x = e->motion.x;
        v->panel.y = e->motion.y;
        if (v->turning || v->shifting) on_drag(v, e->motion.xrel, e->motion.yrel);
        else v->dirty = 1;
        break;
    case SDL_MOUSEWHEEL:
        v->look.view.distance *= exp(-0.12 * e->wheel.y);
        v->moved_at = SDL_GetTicks();
        v->dirty = 1;
        break;
    default: break;
    }
}

/* --- drawing ------------------------------------------------------------------------------------ */

static void draw_panel(struct window *v, int bottom)
{
    const double start = fl_playback_start(&v->s->play), end = fl_playback_end(&v->s->play);
    char text[64], rate[32];
    v->panel.p = &v->overlay;
    panel_begin(&v->panel, bottom);
    if (v->s->file) {
        if (panel_button(&v->panel, "|<", 0)) on_key(v, SDLK_HOME);
        if (panel_button(&v->panel, v->playing ? "pause" : "play", v->playing)) on_key(v, SDLK_SPACE);
        if (panel_button(&v->panel, v->backward ? "<" : ">", v->backward)) on_key(v, SDLK_r);
        if (panel_button(&v->panel, "-", 0)) on_key(v, SDLK_MINUS);
        snprintf(rate, sizeof rate, "x %g", v->rate);
        panel_button(&v->panel, rate, 0);
        if (panel_button(&v->panel, "+", 0)) on_key(v, SDLK_PLUS);
    }
    snprintf(text, sizeof text, "by %s", fl_colour_by_name[v->look.colour.by]);
    if (panel_button(&v->panel, text, 0)) on_key(v, SDLK_c);
    if (panel_button(&v->panel, fl_colour_map_name[v->look.colour.map], 0)) on_key(v, SDLK_m);
    if (panel_button(&v->panel, "water", v->look.water.shown)) on_key(v, SDLK_w);
    if (panel_button(&v->panel, "plan", 0)) on_key(v, SDLK_2);
    if (panel_button(&v->panel, "video", v->filming)) on_key(v, SDLK_v);
    if (panel_button(&v->panel, "?", v->help)) on_key(v, SDLK_h);
    if (v->s->file && end > start) {
        double part = (v->t - start) / (end - start);
        snprintf(text, sizeof text, "t = %.2f s", v->t);
        if (panel_bar(&v->panel, &part, text)) {
            v->t = start + part * (end - start);
            v->dirty = 1;
        }
    }
    v->panel.pressed = 0;
}

static void draw_overlay(struct window *v)
{
    static const fl_rgb paper = {{20, 32, 40}}, ink = {{236, 242, 246}};
    const int strip = strip_of(v), curve = subject_strip(v->s, &v->look, v->w, v->h);
    fl_picture above = {v->overlay.px, v->w, v->h - strip};
    fl_look l = v->look;
    memset(v->overlay.px, 0, 4 * (size_t)v->w * (size_t)v->h);
    l.picture.curve = 0;
    l.picture.time = 0;
    subject_legend(v->s, &l, subject_time(v->s), &above);
    if (curve) {
        l = v->look;
        l.picture.legend = l.picture.time = 0;
        subject_legend(v->s, &l, subject_time(v->s), &v->overlay);
    }
    draw_panel(v, curve);
    if (v->note[0]) fl_legend_note(&v->overlay, v->note);
    for (int k = 0; v->help && HELP[k]; k++) {
        const float y = 70.0f + 26.0f * (float)k;
        fl_picture_plate(&v->overlay, 18, (int)y - 18, 18 + (int)fl_picture_text_width(HELP[k], 10) + 24,
                         (int)y + 8, paper, 0.8f);
        fl_picture_text(&v->overlay, 30, y, 10, HELP[k], ink);
    }
}

/* A frame for the film: what is seen above the panel. */
static int film_frame(struct window *v, fl_err *err)
{
    fl_picture p = {0};
    if (v->seen.w != v->film_w || v->seen.h != v->film_h) {
        fl_picture_free(&v->seen);
        if (fl_picture_make(&v->seen, v->film_w, v->film_h, err)) return -1;
    }
    if (fl_picture_make(&p, v->w, v->h - strip_of(v), err)) return -1;
    int rc = fl_gl_view_read(v->gl, &p, err);
    if (rc == 0) {
        fl_look l = v->look;
        l.picture.curve = 0;
        subject_legend(v->s, &l, subject_time(v->s), &p);
        for (int y = 0; y < v->film_h && y < p.h; y++)
            memcpy(v->seen.px + 4 * (size_t)y * (size_t)v->film_w, p.px + 4 * (size_t)y * (size_t)p.w,
                   4 * (size_t)(v->film_w < p.w ? v->film_w : p.w));
        rc = fl_film_add(&v->film, &v->seen, err);
    }
    fl_picture_free(&p);
    return rc;
}

static int draw_window(struct window *v, fl_err *err)
{
    if (resize(v, err)) return -1;
    if (v->range_due) {
        if (subject_range(v->s, &v->look, err)) return -1;
        v->range_due = 0;
    }
    if (subject_at(v->s, &v->look, v->t, err)) return -1;
    if (v->picked >= 0) subject_tell(v->s, v->picked, v->note);
    const int strip = strip_of(v), h = v->h - strip;
    const int moving = !v->filming && SDL_GetTicks() - v->moved_at < SETTLE_MS ? 2 : 1;
    const fl_gl_quality q = fl_gl_view_quality(&v->look, v->w, h, moving);
    const fl_camera c = subject_camera(v->s, &v->look, (double)v->w / h, 0.0);
    if (fl_gl_view_draw(v->gl, &v->s->shown, &v->look, &c, q, v->s->sea.height ? &v->s->sea : NULL, err))
        return -1;
    if (v->filming && film_frame(v, err)) return -1;
    v->dirty = moving == 2; /* once more, better, when it rests */
    draw_overlay(v);
    fl_gl_view_show(v->gl, v->w, v->h, strip, &v->overlay);
    SDL_GL_SwapWindow(v->window);
    return 0;
}

/* Time goes on; at an end it begins anew, but not that of a run under way, which is followed. */
static void advance(struct window *v, fl_err *err)
{
    const uint32_t now = SDL_GetTicks();
    const double seconds = v->filming ? 1.0 / FILM_FPS : fmin(0.25, 1e-3 * (now - v->last));
    const double start = fl_playback_start(&v->s->play), end = fl_playback_end(&v->s->play);
    v->last = now;
    if (v->spinning) {
        v->look.view.azimuth += seconds * (v->look.view.spin != 0.0 ? v->look.view.spin : SPIN_SPEED);
        v->dirty = 1;
    }
    if (v->s->file && now - v->followed_at > FOLLOW_MS) {
        v->followed_at = now;
        const int32_t more = fl_frame_file_extend(v->s->file, err);
        if (more > 0) v->dirty = 1;
    }
    if (!v->playing || !v->s->file) return;
    v->t += (v->backward ? -1.0 : 1.0) * v->rate * seconds;
    if (v->t > end) v->t = v->filming ? end : start;
    if (v->t < start) v->t = v->filming ? start : end;
    v->dirty = 1;
}

int window_run(struct subject *s, const struct options *o, fl_err *err)
{
    struct window v = {
        .s = s, .o = o, .look = o->look, .rate = 1.0, .picked = -1, .range_due = 1, .dirty = 1};
    int rc = -1;
    v.t = isnan(o->at) ? fl_playback_start(&s->play) : o->at;
    if (subject_fit_all(s, fl_playback_start(&s->play), fl_playback_end(&s->play), err) ||
        subject_at(s, &v.look, v.t, err) || open_window(&v, err) || resize(&v, err))
        goto done;
    fix_camera(&v);
    v.last = v.followed_at = SDL_GetTicks();
    v.moved_at = v.last - SETTLE_MS;
    if (o->verbose) fprintf(stderr, "ice-view: window of %d x %d\n", v.w, v.h);
    while (!v.ended) {
        SDL_Event e;
        const uint32_t began = SDL_GetTicks();
        while (SDL_PollEvent(&e)) on_event(&v, &e);
        advance(&v, err);
        if (err->code || (v.dirty && draw_window(&v, err))) goto done;
        const uint32_t took = SDL_GetTicks() - began;
        if (took < FRAME_MS) SDL_Delay(FRAME_MS - took);
    }
    rc = 0;
    if (v.filming) {
        v.filming = 0;
        rc = fl_film_close(&v.film, err);
    }
done:
    close_window(&v);
    return rc;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/stream.h"
#include "stat/extreme.h"
#include "stat/histogram.h"
#include "legrows.h"
#include "plot.h"

enum {
    PARTS_MAX = 24,
    NAME_MAX_LEN = 80,
    WIDTH = 1000,
    PANEL = 200,
    HEAD = 66,
    GAP = 26,
    FOOT = 70,
    STRETCHES = 2000,
    CLASSES = 20,
    ALL_RANKS = 200
};

typedef struct {
    const struct result *r;
    const struct options *o;
    const fl_by *by;
    int32_t part;
    const char *what;        /* "history", "peaks" */
    char stem[NAME_MAX_LEN]; /* "history-tower" */
    int panels;
    FILE *data, *script;
    int gap;    /* between panels [pixels]: room for what is written below each */
    int blocks; /* of the data file so far: what gnuplot calls its index */
    int curves; /* of the panel so far */
} picture;

/* --- names and units ------------------------------------------------------------------------------------ */

static const char *title_of(const char *signal)
{
    static const char *const known[][2] = {
        {"fx", "Force in x"},       {"fy", "Force in y"},     {"fz", "Force in z"},
        {"fh", "Horizontal force"}, {"f", "Force"},           {"mx", "Moment about x"},
        {"my", "Moment about y"},   {"mz", "Moment about z"}, {"fpeak", "Largest force"},
        {"contacts", "Contacts"}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(signal, known[k][0]) == 0) return known[k][1];
    return signal;
}

plot_scale plot_scale_of(const char *unit, double large)
{
    if ((unit[0] != 'N' && strcmp(unit, "Pa") != 0) || large < 1e3) return (plot_scale){1.0, ""};
    return large < 1e6 ? (plot_scale){1e-3, "k"} : (plot_scale){1e-6, "M"};
}

static double largest_of(const picture *p, int32_t s)
{
    const fl_describe *d = &view_of(p->r, p->part, s, 0)->d;
    return fmax(fabs(d->min), fabs(d->max));
}

static plot_scale scale_of(const picture *p, int32_t s)
{
    return plot_scale_of(p->r->s->unit[s], largest_of(p, s));
}

/* A text in a gnuplot script, between single quotes. */
void plot_quoted(FILE *f, const char *text)
{
    putc('\'', f);
    for (; *text; text++) {
        if (*text == '\'') putc('\'', f);
        putc(*text, f);
    }
    putc('\'', f);
}

void plot_axis(char *label, size_t size, const char *signal, const char *unit, double large)
{
    const char *title = title_of(signal);
    if (unit[0]) snprintf(label, size, "%.200s  [%s%.60s]", title, plot_scale_of(unit, large).prefix, unit);
    else snprintf(label, size, "%.200s", title);
}

static void axis_text(const picture *p, int32_t s, char *label, size_t size)
{
    plot_axis(label, size, p->r->s->signal[s], p->r->s->unit[s], largest_of(p, s));
}

/* gnuplot puts the title of a vertical axis beside its longest number; at one place the titles line up. */
static void put_left_title(const picture *p, const char *text, double x)
{
    fputs("set label 2 ", p->script);
    plot_quoted(p->script, text);
    fprintf(p->script, " at screen %.4f, graph 0.5 center rotate\n", x);
}

/* A part may have any name; a file has a plain one, told apart by the number of the part where that is not
 * enough. */
static void make_stem(picture *p)
{
    const char *name = p->r->s->part[p->part];
    int plain = strlen(name) < 40 && name[0] != '\0', n;
    n = snprintf(p->stem, sizeof p->stem, "%s-%.40s", p->what, strcmp(name, "-") == 0 ? "all" : name);
    for (char *c = p->stem; *c; c++) {
        if (strchr("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.", *c)) continue;
        *c = '_';
        plain = 0;
    }
    if (!plain) snprintf(p->stem + n, sizeof p->stem - (size_t)n, "+%d", p->part);
}

/* --- data ----------------------------------------------------------------------------------------------- */

static void start_block(picture *p)
{
    if (p->blocks++) fputs("\n\n", p->data);
}

static void label_row(const picture *p, int32_t s, int w)
{
    const char *unit = p->r->s->unit[s];
    fprintf(p->data, "%s\t%s\t%s", p->r->s->signal[s], unit[0] ? unit : "-", view_name(w));
}

static void put_columns(const picture *p, int n, const double *x)
{
    for (int k = 0; k < n; k++) {
        putc('\t', p->data);
        put_number(p->data, x[k]);
    }
    putc('\n', p->data);
}

static void history_row(const picture *p, int32_t s, int w, double t, double x)
{
    label_row(p, s, w);
    put_columns(p, 2, (double[]){t, x});
}

/* A row of a loads table is the mean of an interval: a step where there is room for it, else its middle. */
static void history_block(picture *p, int32_t s, int w)
{
    const fl_view *v = view_of(p->r, p->part, s, w);
    const int means = strcmp(p->r->s->kind, "loads") == 0, steps = means && w == 0 && v->n <= STRETCHES;
    const int64_t stretches = v->n > 2 * STRETCHES ? STRETCHES : v->n;
    start_block(p);
    for (int32_t k = 0; steps && k < v->n; k++) {
        history_row(p, s, w, v->edge[k], v->x[k]);
        history_row(p, s, w, v->edge[k + 1], v->x[k]);
    }
    for (int64_t j = 0; !steps && j < stretches; j++) {
        const int32_t from = (int32_t)(j * v->n / stretches), to = (int32_t)((j + 1) * v->n / stretches);
        int32_t k[2] = {from, from};
        for (int32_t i = from; i < to; i++) {
            if (v->x[i] < v->x[k[0]]) k[0] = i;
            if (v->x[i] > v->x[k[1]]) k[1] = i;
        }
        const int later = k[0] < k[1], single = k[0] == k[1];
        for (int i = 0; i < 2 - single; i++) {
            const int32_t row = k[i ? later : !later];
            history_row(p, s, w, means ? 0.5 * (v->edge[row] + v->edge[row + 1]) : v->t[row], v->x[row]);
        }
    }
}

/* All of the largest, then in steps of a hundredth of the rank: no picture shows more. */
static int32_t next_rank(int32_t k) { return k < ALL_RANKS ? k + 1 : k + k / (ALL_RANKS / 2); }

static void exceedance_block(picture *p, int32_t s, int w)
{
    const fl_view *v = view_of(p->r, p->part, s, w);
    const int32_t n = v->peaks.n;
    start_block(p);
    for (int32_t k = 0; k < n; k = next_rank(k)) {
        label_row(p, s, w);
        put_columns(p, 3,
                    (double[]){v->value[k], fl_extreme_position(k + 1, n), v->t[v->peaks.at[v->rank[k]]]});
    }
}

static void classes_block(picture *p, int32_t s, int w, const fl_histogram *h)
{
    start_block(p);
    for (int32_t k = 0; k < h->n; k++) {
        label_row(p, s, w);
        put_columns(
            p, 3,
            (double[]){0.5 * (h->range[k] + h->range[k + 1]), h->bin[k], h->range[k + 1] - h->range[k]});
    }
}

/* --- scripts -------------------------------------------------------------------------------------------- */

/* Raw is thin and light, filtered strong; alone, raw is strong. */
static const char *const STYLES = "set style line 1 lc rgb '#85bcdb' lw 1.0 pt 6 ps 0.6\n"
                                  "set style line 2 lc rgb '#08519c' lw 2.0 pt 7 ps 0.5\n"
                                  "set style line 3 lc rgb '#2171b5' lw 1.2 pt 7 ps 0.5\n"
                                  "set style line 9 lc rgb '#dddddd' lw 0.8\n"
                                  "set border 3 lc rgb '#444444' lw 1\n"
                                  "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n"
                                  "set grid back ls 9\n";

void plot_open(FILE *f, const char *stem, const char *format, int width, int height)
{
    fprintf(f, "# gnuplot %s.gp draws %s.%s from %s.tsv\n", stem, stem, format, stem);
    fprintf(f, "if (!exists(\"out\")) out = '%s.%s'\n", stem, format);
    if (strcmp(format, "png") == 0)
        fprintf(f, "set terminal pngcairo noenhanced size %d,%d font 'Sans,11' background '#ffffff'\n", width,
                height);
    else
        fprintf(f,
                "set terminal svg noenhanced size %d,%d dynamic font 'sans-serif,14' background '#ffffff'\n",
                width, height);
    fprintf(f, "set encoding utf8\nset output out\ndata = '%s.tsv'\n", stem);
}

static int height_of(const picture *p) { return HEAD + p->panels * PANEL + (p->panels - 1) * p->gap + FOOT; }

static int is_loads(const picture *p) { return strcmp(p->r->s->kind, "loads") == 0; }

static void open_script(const picture *p, const char *heading)
{
    FILE *f = p->script;
    const int height = height_of(p), png = strcmp(p->o->format, "png") == 0;
    char title[200];
    plot_open(f, p->stem, p->o->format, WIDTH, height);
    fprintf(f, "%sset multiplot\n", STYLES);
    snprintf(title, sizeof title, "%s, %.100s", heading,
             strcmp(p->r->s->part[p->part], "-") == 0 ? p->r->s->kind : p->r->s->part[p->part]);
    fputs("set label 1 ", f);
    plot_quoted(f, title);
    fprintf(f, " at screen 0.5, screen %.4f center font ',%d' textcolor rgb '#111111'\n", 1.0 - 24.0 / height,
            png ? 14 : 18);
    fprintf(f, "set key at screen 0.975, screen %.4f right top horizontal Left reverse samplen 2\n",
            1.0 - 40.0 / height);
}

/* Panel k: all have the same margins, so that axes line up. */
static void place_panel(picture *p, int k, double left, double right)
{
    const double height = height_of(p), top = HEAD + k * (PANEL + p->gap);
    fprintf(p->script, "set lmargin at screen %.4f\nset rmargin at screen %.4f\n", left, right);
    fprintf(p->script, "set tmargin at screen %.4f\nset bmargin at screen %.4f\n", 1.0 - top / height,
            1.0 - (top + PANEL) / height);
    p->curves = 0;
}

/* The next curve of the panel, of the next block of the data. */
static void start_curve(picture *p)
{
    fprintf(p->script, "%sdata index %d ", p->curves++ ? ", \\\n     " : "plot ", p->blocks);
}

/* Title and key belong to the first panel. */
static void end_panel(const picture *p) { fputs("\nunset key\nunset label 1\n", p->script); }

/* A step of 1, 2 or 5 times a power of ten that cuts a range into three to six. */
static double tics(double range)
{
    const double unit = pow(10.0, floor(log10(range / 3.0))), k = range / 3.0 / unit;
    return unit * (k >= 5.0 ? 5.0 : k >= 2.0 ? 2.0 : 1.0);
}

static void history_panel(picture *p, int k, int32_t s)
{
    const struct result *r = p->r;
    const fl_view *v = view_of(r, p->part, s, 0);
    const plot_scale c = scale_of(p, s);
    double lo = v->d.min, hi = v->d.max;
    char text[300];
    for (int w = 1; w < r->each; w++) {
        lo = fmin(lo, view_of(r, p->part, s, w)->d.min);
        hi = fmax(hi, view_of(r, p->part, s, w)->d.max);
    }
    if (!(hi > lo)) { /* a constant has no range of its own */
        const double room = lo != 0.0 ? 0.5 * fabs(lo) : 1.0;
        lo -= room;
        hi += room;
    }
    place_panel(p, k, 0.095, 0.97);
    fprintf(p->script, "set xrange [%.10g:%.10g]\n", v->edge[0], v->edge[v->n]);
    fprintf(p->script, "set yrange [%.6g:%.6g]\nset ytics %.6g\n", c.factor * (lo - 0.04 * (hi - lo)),
            c.factor * (hi + 0.04 * (hi - lo)), tics(c.factor * (hi - lo)));
    axis_text(p, s, text, sizeof text);
    put_left_title(p, text, 0.022);
    if (k + 1 == p->panels) fputs("set xlabel 'Time  [s]'\nset format x '%g'\n", p->script);
    else fputs("set format x ''\n", p->script);
    for (int w = 0; w < r->each; w++) {
        start_curve(p);
        fprintf(p->script, "using 4:($5*%g) with lines ls %d title '%s", c.factor, r->each > 1 ? w + 1 : 3,
                view_name(w));
        if (w) fprintf(p->script, ", %g Hz'", p->o->filter);
        else putc('\'', p->script);
        history_block(p, s, w);
    }
    end_panel(p);
}

static int history(picture *p, fl_err *err)
{
    int k = 0;
    (void)err;
    p->gap = GAP;
    for (int32_t s = 0; s < p->r->s->signals; s++) p->panels += view_of(p->r, p->part, s, 0) != NULL;
    fputs("signal\tunit\tview\tt[s]\tvalue\n", p->data);
    open_script(p, is_loads(p) ? "Load history" : "History");
    for (int32_t s = 0; s < p->r->s->signals; s++)
        if (view_of(p->r, p->part, s, 0)) history_panel(p, k++, s);
    return 0;
}

/* Peaks of a signal in any of its views? */
static int32_t peaks_of(const picture *p, int32_t s)
{
    int32_t n = 0;
    for (int w = 0; view_of(p->r, p->part, s, 0) && w < p->r->each; w++)
        n += view_of(p->r, p->part, s, w)->peaks.n;
    return n;
}

/* Left, how many peaks there are in each class; both views share the classes. */
static int classes_panel(picture *p, int k, int32_t s, fl_err *err)
{
    const struct result *r = p->r;
    const plot_scale c = scale_of(p, s);
    fl_histogram h[2] = {{0}, {0}};
    double lo = INFINITY, hi = -INFINITY, most = 0.0;
    char text[300];
    int rc = -1;
    for (int w = 0; w < r->each; w++) {
        const fl_view *v = view_of(r, p->part, s, w);
        if (!v->peaks.n) continue;
        hi = fmax(hi, v->value[0]);
        lo = fmin(lo, v->value[v->peaks.n - 1]);
    }
    for (int w = 0; w < r->each; w++) {
        const fl_view *v = view_of(r, p->part, s, w);
        if (fl_histogram_make(&h[w], CLASSES, lo, hi, err)) goto done;
        for (int32_t i = 0; i < v->peaks.n; i++) fl_histogram_add(&h[w], v->value[i], 1.0);
        for (int32_t i = 0; i < CLASSES; i++) most = fmax(most, h[w].bin[i]);
    }
    place_panel(p, k, 0.1, 0.475);
    axis_text(p, s, text, sizeof text);
    fputs("set xlabel ", p->script);
    plot_quoted(p->script, text);
    putc('\n', p->script);
    fprintf(p->script, "set xtics %.6g\n", tics(c.factor * (h[0].range[CLASSES] - h[0].range[0])));
    put_left_title(p, "Peaks in class", 0.018);
    fprintf(p->script, "unset logscale y\nset yrange [0:%g]\nset ytics %g\n", 1.08 * most,
            fmax(1.0, tics(most)));
    for (int w = 0; w < r->each; w++) {
        start_curve(p);
        fprintf(p->script,
                "using ($4*%g):5:($6*%g) with boxes fill solid 1.0 noborder lc rgb '%s' title '%s'", c.factor,
                c.factor * (w ? 0.45 : 0.92), r->each > 1 ? (w ? "#08519c" : "#9ecae1") : "#2171b5",
                view_name(w));
        classes_block(p, s, w, &h[w]);
    }
    end_panel(p);
    rc = 0;
done:
    fl_histogram_free(&h[0]);
    fl_histogram_free(&h[1]);
    return rc;
}

/* Right, how probable it is that a peak is larger. */
static void exceedance_panel(picture *p, int k, int32_t s)
{
    const plot_scale c = scale_of(p, s);
    place_panel(p, k, 0.58, 0.97);
    put_left_title(p, "Probability of exceedance", 0.508);
    fputs("set xtics autofreq\nset logscale y\nset yrange [*:1]\nset ytics "
          "autofreq\nset "
          "format y '%g'\n",
          p->script);
    for (int w = 0; w < p->r->each; w++) {
        if (!view_of(p->r, p->part, s, w)->peaks.n) continue;
        start_curve(p);
        fprintf(p->script, "using ($4*%g):5 with points ls %d title '%s'", c.factor,
                p->r->each > 1 ? w + 1 : 3, view_name(w));
        exceedance_block(p, s, w);
    }
    end_panel(p);
}

static int peaks(picture *p, fl_err *err)
{
    int k = 0;
    p->gap = FOOT + 10;
    for (int32_t s = 0; s < p->r->s->signals; s++) p->panels += peaks_of(p, s) > 0;
    fputs("signal\tunit\tview\tpeak\tcount_or_P\twidth_or_t\n", p->data);
    open_script(p, is_loads(p) ? "Load peaks" : "Peaks");
    for (int32_t s = 0; s < p->r->s->signals; s++) {
        if (!peaks_of(p, s)) continue;
        if (classes_panel(p, k, s, err)) return -1;
        exceedance_panel(p, k++, s);
    }
    return 0;
}

/* --- running gnuplot ------------------------------------------------------------------------------------ */

/* Run gnuplot in the folder; what it says on stderr comes back in said.  Returns its exit status, or -1. */
static int run_gnuplot(const char *dir, const char *setting, const char *script, char *said, size_t size)
{
    int pipe_fd[2], status = 0;
    size_t have = 0;
    ssize_t k;
    said[0] = '\0';
    if (pipe(pipe_fd) != 0) return -1;
    const pid_t pid = fork();
    if (pid < 0) {
        close(pipe_fd[0]);
        close(pipe_fd[1]);
        return -1;
    }
    if (pid == 0) {
        const int null = open("/dev/null", O_RDWR);
        if (null < 0 || dup2(null, 0) < 0 || dup2(null, 1) < 0 || dup2(pipe_fd[1], 2) < 0 || chdir(dir) != 0)
            _exit(126);
        close(pipe_fd[0]);
        /* -d: a user's own start-up file must not change the picture. */
        execlp("gnuplot", "gnuplot", "-d", "-e", setting, script, (char *)NULL);
        _exit(errno == ENOENT ? 127 : 126);
    }
    close(pipe_fd[1]);
    for (;;) {
        char more[512];
        k = read(pipe_fd[0], more, sizeof more);
        if (k < 0 && errno == EINTR) continue;
        if (k <= 0) break;
        for (ssize_t j = 0; j < k && have + 1 < size; j++) said[have++] = more[j];
    }
    said[have] = '\0';
    close(pipe_fd[0]);
    while (waitpid(pid, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* The line of gnuplot's complaint that says what is wrong: the last one that is not empty. */
static const char *complaint(char *said)
{
    const char *last = "no reason given";
    for (char *line = strtok(said, "\r\n"); line; line = strtok(NULL, "\r\n"))
        if (line[strspn(line, " \t^")]) last = line + strspn(line, " \t");
    return last;
}

int plot_path(char path[PLOT_PATH_LEN], const char *dir, const char *stem, const char *end, fl_err *err)
{
    if (snprintf(path, PLOT_PATH_LEN, "%s/%s.%s", dir, stem, end) < PLOT_PATH_LEN) return 0;
    return fl_fail(err, FL_SYSTEM, "the name of a picture in %.100s is too long", dir);
}

/* gnuplot draws under another name, which becomes the final one when the picture is complete. */
int plot_draw(const char *dir, const char *stem, const char *format, fl_err *err)
{
    char script[NAME_MAX_LEN + 8], setting[NAME_MAX_LEN + 24], part[PLOT_PATH_LEN], path[PLOT_PATH_LEN],
        said[2000];
    struct stat st;
    snprintf(script, sizeof script, "%s.gp", stem);
    snprintf(setting, sizeof setting, "out = '%s.%s.part'", stem, format);
    char end[40];
    snprintf(end, sizeof end, "%.30s.part", format);
    if (plot_path(part, dir, stem, end, err) || plot_path(path, dir, stem, format, err)) return -1;
    const int status = run_gnuplot(dir, setting, script, said, sizeof said);
    if (status == 127) return fl_fail(err, FL_SYSTEM, "gnuplot was not found, it draws what --plot asks for");
    if (status != 0 || stat(part, &st) != 0 || st.st_size == 0) {
        unlink(part);
        return fl_fail(err, FL_SYSTEM, "gnuplot failed on %s/%s: %.200s", dir, script, complaint(said));
    }
    return rename(part, path) == 0 ? 0 : fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
}

/* --- all pictures --------------------------------------------------------------------------------------- */

static int make(const picture *plan, int (*fill)(picture *, fl_err *), fl_err *err)
{
    picture p = *plan;
    fl_out data = {0}, script = {0};
    char path[PLOT_PATH_LEN];
    int rc = -1;
    make_stem(&p);
    if (plot_path(path, p.o->plot, p.stem, "tsv", err) || fl_out_open(&data, path, 0, err)) goto done;
    if (plot_path(path, p.o->plot, p.stem, "gp", err) || fl_out_open(&script, path, 0, err)) goto done;
    p.data = data.f;
    p.script = script.f;
    fl_by_header(p.data, p.what, 1, p.r->s->history, p.by);
    if (fill(&p, err)) goto done;
    fputs("unset multiplot\nset output\n", p.script);
    if (fl_out_close(&data, err) || fl_out_close(&script, err)) goto done;
    rc = plot_draw(p.o->plot, p.stem, p.o->format, err);
done:
    fl_out_abort(&data);
    fl_out_abort(&script);
    return rc;
}

int plot(const struct result *r, const struct options *o, const fl_by *by, fl_err *err)
{
    const int32_t parts = r->s->parts, alone = parts == 2 && strcmp(r->s->part[1], "total") == 0;
    picture p = {.r = r, .o = o, .by = by};
    int made = 0;
    if (parts > PARTS_MAX)
        return fl_fail(err, FL_USAGE, "--plot draws at most %d parts, here are %d: choose one with --part",
                       PARTS_MAX, parts);
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    for (p.part = alone; p.part < parts; p.part++) {
        int32_t n = 0, shown = 0;
        for (int32_t s = 0; s < r->s->signals; s++) {
            n += peaks_of(&p, s);
            shown += view_of(r, p.part, s, 0) != NULL;
        }
        if (!shown) continue;
        p.what = "history";
        if (make(&p, history, err)) return -1;
        p.what = "peaks";
        if (n && make(&p, peaks, err)) return -1;
        if (!n && !o->quiet) fprintf(stderr, "loadstats: %s has no peaks to draw\n", r->s->part[p.part]);
        made += 1 + (n > 0);
    }
    if (o->table == TABLE_LEGS || (o->page && !alone && parts > 2)) {
        if (legrows_plot(r, o, by, err)) return -1;
        made++;
    }
    if (!o->quiet) fprintf(stderr, "loadstats: %d picture(s) in %s\n", made, o->plot);
    return 0;
}

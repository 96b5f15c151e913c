/* The yardstick (yardstick.py) as plain scalar C: what its arithmetic costs on this machine. peers.py compiles it.

   p, v, m and m/s in the navigation frame; R, foot to navigation frame; P, covariance of the errors of p, v, attitude. */
#include <math.h>
#include <string.h>
#define WINDOW 5
static const double G = 9.80665, LIMIT = 3e5, SIGMA_ACC = 0.01, SIGMA_GYRO = M_PI / 1800, ACC_NOISE = 0.5,
                    GYRO_NOISE = M_PI / 360, ZERO_VELOCITY = 0.01;
typedef struct { double t, p[3], v[3], R[3][3], P[9][9], window[WINDOW][6]; long count; } Filter;

/* R becomes exp(r) R, or R exp(r) if it is on the right. */
static void turn(double R[3][3], const double r[3], int right) {
    double a = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]), s = a > 0 ? sin(a) / a : 1, c = a > 0 ? (1 - cos(a)) / (a * a) : 0.5;
    double E[3][3], old[3][3], K[3][3] = {{0, -r[2], r[1]}, {r[2], 0, -r[0]}, {-r[1], r[0], 0}};
    memcpy(old, R, sizeof old);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) E[i][j] = (i == j ? 1 - c * a * a : 0) + s * K[i][j] + c * r[i] * r[j];
    double (*A)[3] = right ? old : E, (*B)[3] = right ? E : old;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) R[i][j] = A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
}

static void predict(Filter *f, double dt, const double *acc, const double *gyro) {
    double a[3], w[3] = {gyro[0] * dt, gyro[1] * dt, gyro[2] * dt}, (*P)[9] = f->P;
    turn(f->R, w, 1);
    for (int i = 0; i < 3; i++) a[i] = f->R[i][0] * acc[0] + f->R[i][1] * acc[1] + f->R[i][2] * acc[2];
    double S[3][3] = {{0, a[2] * dt, -a[1] * dt}, {-a[2] * dt, 0, a[0] * dt}, {a[1] * dt, -a[0] * dt, 0}};
    a[2] -= G;
    for (int i = 0; i < 3; i++) f->p[i] += f->v[i] * dt + 0.5 * a[i] * dt * dt, f->v[i] += a[i] * dt;
    for (int j = 0; j < 9; j++) /* F P */
        for (int i = 0; i < 3; i++) P[i][j] += dt * P[3 + i][j];
    for (int j = 0; j < 9; j++)
        for (int i = 0; i < 3; i++) P[3 + i][j] += S[i][0] * P[6][j] + S[i][1] * P[7][j] + S[i][2] * P[8][j];
    for (int j = 0; j < 9; j++) /* (F P) F' */
        for (int i = 0; i < 3; i++) P[j][i] += dt * P[j][3 + i];
    for (int j = 0; j < 9; j++)
        for (int i = 0; i < 3; i++) P[j][3 + i] += S[i][0] * P[j][6] + S[i][1] * P[j][7] + S[i][2] * P[j][8];
    for (int i = 3; i < 9; i++) P[i][i] += dt * dt * (i < 6 ? ACC_NOISE * ACC_NOISE : GYRO_NOISE * GYRO_NOISE);
}

static void correct(Filter *f) { /* three scalar updates, since the noise of the velocities is independent */
    double e[9] = {0}, k[9], row[9];
    for (int n = 3; n < 6; n++) {
        double innovation = -f->v[n - 3] - e[n], s = f->P[n][n] + ZERO_VELOCITY * ZERO_VELOCITY;
        memcpy(row, f->P[n], sizeof row);
        for (int i = 0; i < 9; i++) k[i] = f->P[i][n] / s, e[i] += k[i] * innovation;
        for (int i = 0; i < 9; i++)
            for (int j = 0; j < 9; j++) f->P[i][j] -= k[i] * row[j];
    }
    for (int i = 0; i < 3; i++) f->p[i] += e[i], f->v[i] += e[3 + i];
    turn(f->R, e + 6, 0);
}

static int is_still(const Filter *f) {
    double mean[3] = {0}, length = 0, total = 0;
    for (int n = 0; n < WINDOW; n++)
        for (int i = 0; i < 3; i++) mean[i] += f->window[n][i];
    for (int i = 0; i < 3; i++) length += mean[i] * mean[i];
    for (int n = 0; n < WINDOW; n++)
        for (int i = 0; i < 3; i++) {
            double a = f->window[n][i] - G * mean[i] / sqrt(length), w = f->window[n][3 + i];
            total += a * a / (SIGMA_ACC * SIGMA_ACC) + w * w / (SIGMA_GYRO * SIGMA_GYRO);
        }
    return total / WINDOW < LIMIT;
}

/* Feeds a sample: t, s; acc, m/s^2; gyro, rad/s. */
void feed(Filter *f, double t, const double *acc, const double *gyro) {
    memcpy(f->window[f->count % WINDOW], acc, 3 * sizeof(double));
    memcpy(f->window[f->count % WINDOW] + 3, gyro, 3 * sizeof(double));
    if (f->count++ == 0) { /* level: turn the specific force at rest to the vertical */
        double n = sqrt(acc[0] * acc[0] + acc[1] * acc[1] + acc[2] * acc[2]), s = hypot(acc[0], acc[1]) / n;
        double by = s > 0 ? atan2(s, acc[2] / n) / s : 0, r[3] = {acc[1] / n * by, -acc[0] / n * by, 0};
        for (int i = 0; i < 9; i++) f->P[i][i] = i < 3 ? 1e-10 : i < 6 ? 1e-4 : 1e-3, f->R[i / 3][i % 3] = i % 4 == 0;
        turn(f->R, r, 0);
    } else predict(f, t - f->t, acc, gyro);
    f->t = t;
    if (f->count >= WINDOW && is_still(f)) correct(f);
}

/* Feeds rows of t, acc and gyro to a new filter; writes its position at the end. */
void feed_all(const double *rows, long count, double *position) {
    Filter f = {0};
    for (long n = 0; n < count; n++) feed(&f, rows[7 * n], rows + 7 * n + 1, rows + 7 * n + 4);
    memcpy(position, f.p, sizeof f.p);
}

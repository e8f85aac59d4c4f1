/* Occlusion of segments by Embree 3, for the benchmark `occlusion`, which compiles it and talks to it through pipes.
 *
 * `embree FILE` reads two counts (u32), the triangles (nine f32 each) and the segments (six f32 each). Then each line
 * "KIND ROBUST THREADS" on its input is one pass over all segments; it answers with the seconds as f64 and a byte for each
 * segment, 1 where something is hit. KIND is 1, 8 or 16 rays at a time, or 0 for streams of 1024 rays (rtcOccluded1M). */
#define _POSIX_C_SOURCE 200809L
#include <embree3/rtcore.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Parts of a segment at its ends in which nothing counts, as what they lie on does not. */
#define NEAR 1e-4f
#define CHUNK 2048
#define STREAM 1024

static uint32_t triangles, segments;
/* Origin x, y, z and direction x, y, z, each one array over all segments. */
static float *side[6];
static uint8_t *hidden;
static RTCScene scene;
static int kind;
static uint32_t next_chunk;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static struct RTCRay ray(uint32_t k) {
    struct RTCRay r = {.org_x = side[0][k], .org_y = side[1][k], .org_z = side[2][k], .tnear = NEAR,
                       .dir_x = side[3][k], .dir_y = side[4][k], .dir_z = side[5][k], .tfar = 1.0f - NEAR,
                       .mask = -1u};
    return r;
}

#define PACKETS(N)                                                                                                     \
    static void packets##N(struct RTCIntersectContext *context, uint32_t from, uint32_t to) {                          \
        for (uint32_t k = from; k < to; k += N) {                                                                      \
            struct RTCRay##N r;                                                                                        \
            int valid[N] __attribute__((aligned(64)));                                                                 \
            for (uint32_t i = 0; i < N; i++) {                                                                         \
                uint32_t at = k + i < to ? k + i : k;                                                                  \
                valid[i] = k + i < to ? -1 : 0;                                                                        \
                r.org_x[i] = side[0][at]; r.org_y[i] = side[1][at]; r.org_z[i] = side[2][at];                          \
                r.dir_x[i] = side[3][at]; r.dir_y[i] = side[4][at]; r.dir_z[i] = side[5][at];                          \
                r.tnear[i] = NEAR; r.tfar[i] = 1.0f - NEAR;                                                            \
                r.time[i] = 0; r.mask[i] = -1u; r.id[i] = 0; r.flags[i] = 0;                                           \
            }                                                                                                          \
            rtcOccluded##N(valid, scene, context, &r);                                                                 \
            for (uint32_t i = 0; i < N && k + i < to; i++) hidden[k + i] = r.tfar[i] < 0;                              \
        }                                                                                                              \
    }
PACKETS(8)
PACKETS(16)

static void one_by_one(struct RTCIntersectContext *context, uint32_t from, uint32_t to) {
    for (uint32_t k = from; k < to; k++) {
        struct RTCRay r = ray(k);
        rtcOccluded1(scene, context, &r);
        hidden[k] = r.tfar < 0;
    }
}

static void streams(struct RTCIntersectContext *context, uint32_t from, uint32_t to) {
    static _Thread_local struct RTCRay rays[STREAM];
    for (uint32_t k = from; k < to; k += STREAM) {
        uint32_t count = to - k < STREAM ? to - k : STREAM;
        for (uint32_t i = 0; i < count; i++) rays[i] = ray(k + i);
        rtcOccluded1M(scene, context, rays, count, sizeof *rays);
        for (uint32_t i = 0; i < count; i++) hidden[k + i] = rays[i].tfar < 0;
    }
}

static void *work(void *unused) {
    (void)unused;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = kind == 1 ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (;;) {
        pthread_mutex_lock(&lock);
        uint32_t from = next_chunk;
        next_chunk += CHUNK;
        pthread_mutex_unlock(&lock);
        if (from >= segments) return NULL;
        uint32_t to = from + CHUNK < segments ? from + CHUNK : segments;
        switch (kind) {
            case 0: streams(&context, from, to); break;
            case 1: one_by_one(&context, from, to); break;
            case 8: packets8(&context, from, to); break;
            default: packets16(&context, from, to);
        }
    }
}

static double pass(int threads) {
    struct timespec start, end;
    pthread_t others[64];
    next_chunk = 0;
    clock_gettime(CLOCK_MONOTONIC, &start);
    for (int k = 1; k < threads; k++) pthread_create(&others[k], NULL, work, NULL);
    work(NULL);
    for (int k = 1; k < threads; k++) pthread_join(others[k], NULL);
    clock_gettime(CLOCK_MONOTONIC, &end);
    return (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
}

static RTCScene build(RTCDevice device, const float *corners, int robust) {
    RTCScene built = rtcNewScene(device);
    rtcSetSceneFlags(built, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(built, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * triangles);
    unsigned *numbers = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles);
    memcpy(vertices, corners, (size_t)triangles * 36);
    for (uint32_t k = 0; k < 3 * triangles; k++) numbers[k] = k;
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(built, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(built);
    return built;
}

int main(int count, char **arguments) {
    FILE *file = count == 2 ? fopen(arguments[1], "rb") : NULL;
    if (!file || fread(&triangles, 4, 1, file) != 1 || fread(&segments, 4, 1, file) != 1) return 1;
    float *corners = malloc((size_t)triangles * 36), *ends = malloc((size_t)segments * 24);
    if (fread(corners, 36, triangles, file) != triangles || fread(ends, 24, segments, file) != segments) return 1;
    for (int k = 0; k < 6; k++) side[k] = malloc((size_t)segments * 4);
    for (uint32_t k = 0; k < segments; k++)
        for (int i = 0; i < 3; i++) {
            side[i][k] = ends[6 * k + i];
            side[3 + i][k] = ends[6 * k + 3 + i] - ends[6 * k + i];
        }
    hidden = malloc(segments);
    RTCDevice device = rtcNewDevice(NULL);
    if (!device) return 1;
    RTCScene scenes[2] = {build(device, corners, 0), build(device, corners, 1)};
    int robust, threads;
    while (scanf("%d %d %d", &kind, &robust, &threads) == 3) {
        scene = scenes[robust];
        double seconds = pass(threads);
        fwrite(&seconds, 8, 1, stdout);
        fwrite(hidden, 1, segments, stdout);
        fflush(stdout);
    }
    return 0;
}

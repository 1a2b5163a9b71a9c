// What is asked of Embree 3: one scene of triangles, first hits, and 49 occlusion rays for each hit in packets of 16.
#include <embree3/rtcore.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct scene {
    RTCDevice device;
    RTCScene scene;
};

// Builds the hierarchy, on one thread. Positions: 3 floats a vertex, copied. Null if Embree refuses.
struct scene *embree_build(const float *positions, size_t vertices, const unsigned *indices, size_t triangles) {
    RTCDevice device = rtcNewDevice("threads=1");
    if (!device)
        return NULL;
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *v = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices);
    unsigned *t = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles);
    if (!v || !t)
        return NULL;
    memcpy(v, positions, vertices * 12);
    memcpy(t, indices, triangles * 12);
    rtcCommitGeometry(mesh);
    struct scene *built = malloc(sizeof *built);
    built->device = device;
    built->scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(built->scene, RTC_BUILD_QUALITY_HIGH);
    rtcAttachGeometry(built->scene, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(built->scene);
    return built;
}

void embree_free(struct scene *s) {
    rtcReleaseScene(s->scene);
    rtcReleaseDevice(s->device);
    free(s);
}

// Parameters of the first hits of `n` rays from `eye` along `directions`; negative where there is none.
void embree_hits(struct scene *s, const float eye[3], const float *directions, size_t n, float *t) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (size_t begin = 0; begin < n; begin += 16) {
        struct RTCRayHit16 r;
        _Alignas(64) int valid[16];
        for (size_t k = 0; k < 16; k++) {
            size_t i = begin + k < n ? begin + k : n - 1;
            valid[k] = begin + k < n ? -1 : 0;
            r.ray.org_x[k] = eye[0], r.ray.org_y[k] = eye[1], r.ray.org_z[k] = eye[2];
            r.ray.dir_x[k] = directions[3 * i], r.ray.dir_y[k] = directions[3 * i + 1], r.ray.dir_z[k] = directions[3 * i + 2];
            r.ray.tnear[k] = 0, r.ray.tfar[k] = INFINITY, r.ray.time[k] = 0, r.ray.mask[k] = -1, r.ray.flags[k] = 0;
            r.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(valid, s->scene, &context, &r);
        for (size_t k = 0; k < 16 && begin + k < n; k++)
            t[begin + k] = r.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? -1 : r.ray.tfar[k];
    }
}

// For each of `n` points, the share of 49 targets (3 floats each) that it sees; rays begin at the part `bias` of the way.
void embree_visible(struct scene *s, const float *points, size_t n, const float *targets, float bias, float *share) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (size_t i = 0; i < n; i++) {
        const float *p = points + 3 * i;
        int seen = 0;
        for (int begin = 0; begin < 49; begin += 16) {
            struct RTCRay16 r;
            _Alignas(64) int valid[16];
            for (int k = 0; k < 16; k++) {
                int j = begin + k < 49 ? begin + k : 48;
                const float *q = targets + 3 * j;
                valid[k] = begin + k < 49 ? -1 : 0;
                r.org_x[k] = p[0], r.org_y[k] = p[1], r.org_z[k] = p[2];
                r.dir_x[k] = q[0] - p[0], r.dir_y[k] = q[1] - p[1], r.dir_z[k] = q[2] - p[2];
                r.tnear[k] = bias, r.tfar[k] = 1, r.time[k] = 0, r.mask[k] = -1, r.flags[k] = 0;
            }
            rtcOccluded16(valid, s->scene, &context, &r);
            for (int k = 0; k < 16 && begin + k < 49; k++)
                seen += r.tfar[k] >= 0;
        }
        share[i] = seen / 49.0f;
    }
}

"""Mutants drawn at random: an operator, a comparison, a constant or a bound of a random line of include/."""
import hashlib
import pathlib
import re

# What stands instead of what; a line of code is formatted, so operators have spaces and templates have none.
OPERATORS = [(r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "), (r" == ", " != "), (r" != ", " == "),
             (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" && ", " || "), (r" \|\| ", " && "),
             (r" \+= ", " -= "), (r" -= ", " += "), (r"\(std::min\)", "(std::max)"), (r"\(std::max\)", "(std::min)"),
             (r"\bmin_\(", "max_("), (r"\bmax_\(", "min_("), (r"\badd\(", "sub("), (r"\bsub\(", "add("), (r"\bmadd\(", "nmadd("),
             (r"\bnmadd\(", "madd("), (r"\bgt\(", "lt("), (r"\blt\(", "gt("), (r"return true;", "return false;"),
             (r"return false;", "return true;"), (r"\bif \(!", "if ("), (r"(?<=[ (])-(?=[a-z(])", "")]
INTEGER = re.compile(r"(?<![\w.])(\d+)(?![\w.])")
REAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+)(?=F?\b)")

# The scalar target alone is built; adapters and the macros of the build are not for these tests.
LEFT_OUT = re.compile(r"adapters/|simd/ops/(?!scalar)|simd/targets|simd/dispatch|simd/cpu|simd/tiles|kernels/tiles|config\.hpp|textplane\.hpp|"
                      r"simd/(foreach_target|region)\.inl|simd/ops\.hpp|core/status|core/cache_line")

MAP = ("landmarks/map/text_map_test landmarks/map/text_map_property_test landmarks/map/text_map_life_test "
       "landmarks/map/text_map_restore_test landmarks/text_agreement_test")

# The tests of a header, most telling first; the first pattern that matches counts.
TESTS = [
    ("core/numeric", "core/numeric_test core/se3_test"), ("core/se3", "core/se3_test"), ("core/robust", "core/robust_test"),
    ("core/order", "core/order_test"), ("core/parse_number", "landmarks/icdar_test"),
    ("core/row_motion", "core/row_motion_test solver/rows/rows_test solver/rows/window_rows_test"),
    ("core/image_view", "core/image_view_test photometry/sample_test"),
    ("core/cameras/lens_map", "core/lens_map_test"), ("core/cameras/lens", "core/camera_test core/camera_domains_test simd/lens/lens_kernels_test"),
    ("core/cameras/radial", "core/radial_tangential_test"),
    ("core/cameras/any", "core/any_camera_test"), ("core/cameras", "core/camera_test core/camera_domains_test"),
    ("geometry/homography", "geometry/homography_test"), ("geometry/plane_fit", "geometry/plane_fit_test geometry/plane_fit_failure_test"),
    ("geometry/plane", "geometry/plane_test"), ("geometry/quad_projection", "geometry/quad_projection_test"),
    ("geometry/quad", "geometry/quad_test geometry/quad_overlap_test geometry/quad_projection_test"), ("geometry/triangulate", "geometry/triangulate_test"),
    ("geometry/row_warp", "geometry/row_warp_test"), ("geometry/undistorted", "geometry/undistorted_test"),
    ("features/fast", "simd/fast_kernels_test features/fast_test features/options_test"),
    ("features/klt", "features/klt_test features/guard_pages_test features/options_test"),
    ("features/select", "features/select_test features/options_test"),
    ("features/", "features/align_test features/klt_test features/guard_pages_test features/options_test"),
    ("photometry/blur", "photometry/blur_test"), ("photometry/local_contrast", "photometry/local_contrast_test"),
    ("photometry/noise", "photometry/noise_test"),
    ("photometry/lens/(lens_fit|text_batch)", "simd/lens/lens_kernels_test simd/lens/lens_borders_test solver/lens_test"), ("photometry/lens/warp", "simd/lens/warp_lens_test"),
    ("photometry/(batch/)?text_batch", "simd/batch_kernels_test simd/batch_visibility_test solver/rows/batch_rows_test"),
    ("photometry/candidates", "simd/zncc_kernels_test solver/policy_test"), ("photometry/zncc", "photometry/zncc_test"),
    ("photometry/sample", "photometry/sample_test photometry/guard_pages_test"), ("photometry/pyramid", "photometry/pyramid_test"),
    ("photometry/patch", "photometry/patch_test photometry/local_contrast_test features/select_test"),
    ("photometry/template_patch", "simd/template_kernels_test simd/zncc_kernels_test"),
    ("photometry/warp_patch", "simd/warp_kernels_test simd/warp_edges_test"),
    ("photometry/world_parameters", "simd/residual_kernels_test photometry/residual_jacobian_test"),
    ("photometry/photometric_input", "photometry/patch_test solver/align_pose_test solver/policy_test"),
    ("photometry/residual_policy", "photometry/residual_policy_test simd/esm_kernels_test simd/hybrid_kernels_test"),
    ("photometry/residual_hybrid", "photometry/residual_policy_test"),
    ("photometry/residual_reference", "photometry/residual_policy_test photometry/residual_jacobian_test photometry/visible_set_test "
                                      "photometry/residual_status_test"),
    ("photometry/", "photometry/residual_jacobian_test photometry/residual_status_test photometry/visible_set_test "
                    "simd/residual_visibility_test simd/residual_kernels_test photometry/residual_cost_test"),
    ("simd/(kernels/)?warp_lens", "simd/lens/warp_lens_test"), ("simd/(kernels/)?lens", "simd/lens/lens_kernels_test simd/lens/lens_borders_test simd/tiles_test"),
    ("simd/kernels/residual/batch|simd/batch", "simd/batch_kernels_test simd/batch_visibility_test simd/stated_bounds_test"),
    ("simd/kernels/residual/(esm|host_basis)|simd/esm", "simd/esm_kernels_test simd/template_kernels_test"),
    ("simd/(kernels/residual/)?hybrid", "simd/hybrid_kernels_test"),
    ("simd/kernels/residual/moments", "simd/residual_kernels_test simd/esm_kernels_test"),
    ("simd/kernels/residual/template|simd/template", "simd/template_kernels_test simd/zncc_kernels_test simd/robust_kernels_test "
                                                "simd/tiles_test"),
    ("simd/kernels/zncc|simd/zncc", "simd/zncc_kernels_test"), ("simd/(kernels/)?klt", "simd/klt_kernels_test features/klt_test"),
    ("simd/(kernels/)?fast", "simd/fast_kernels_test"), ("simd/(kernels/)?halve", "simd/halve_kernels_test"),
    ("simd/(kernels/)?warp", "simd/warp_kernels_test simd/warp_edges_test"),
    ("simd/kernels/residual/(collect|frame)", "simd/residual_visibility_test simd/residual_kernels_test simd/esm_kernels_test "
                                              "simd/batch_kernels_test simd/tiles_test simd/lens/lens_kernels_test simd/lens/lens_borders_test"),
    ("simd/kernels/residual/centre", "simd/residual_kernels_test simd/esm_kernels_test"),
    ("simd/kernels/(sample|points)|simd/sample", "simd/sample_points_test simd/residual_kernels_test simd/residual_visibility_test "
                                           "simd/tiles_test"),
    ("simd/(kernels/)?robust", "simd/robust_kernels_test"),
    ("simd/ops/", "simd/ops/bytes_kernels_test simd/ops/vec_test simd/ops/robust_ops_test simd/residual_kernels_test "
                  "simd/batch_kernels_test simd/klt_kernels_test simd/sample_points_test"),
    ("simd/", "simd/residual_kernels_test simd/residual_visibility_test simd/robust_kernels_test simd/stated_bounds_test "
              "simd/batch_kernels_test simd/warp_kernels_test"),
    ("solver/window_calibration", "solver/window_calibration_test solver/window_linear_test"),
    ("solver/window_velocity", "solver/rows/window_rows_test"), ("solver/jackknife", "solver/jackknife_test"),
    ("solver/window", "solver/window_linear_test solver/window_test solver/window_input_test solver/window_gauge_test "
                      "solver/charges_test solver/window_calibration_test solver/rig/window_rig_test solver/rows/window_rows_test"),
    ("solver/block_cholesky", "solver/window_linear_test"), ("solver/plane", "solver/plane_test solver/charges_test"),
    ("solver/pose_batch", "solver/pose_batch_test solver/rows/batch_rows_test"), ("solver/pose_rig", "solver/rig/rig_test"),
    ("solver/search", "solver/policy_test"), ("solver/weighting", "solver/weighting_test"),
    ("solver/gauss_newton", "solver/gauss_newton_test solver/gauss_newton_faults_test"),
    ("solver/", "solver/pose_test solver/pose_batch_test solver/pose_input_test solver/charges_test solver/align_pose_test "
                "solver/policy_test solver/rig/rig_test solver/rows/rows_test"),
    ("landmarks/(icdar|keyframe_store|words)", r"landmarks/\1_test"), ("landmarks/keyframe", "landmarks/text_hosting_test"),
    ("landmarks/planarity", "landmarks/planarity_test"), ("landmarks/text_surface", "landmarks/surface_fit_test landmarks/text_surface_test"),
    ("landmarks/text_(plane|proposal)", "landmarks/text_plane_test landmarks/text_limits_test " + MAP),
    ("landmarks/text_pose", "landmarks/text_pose_test " + MAP),
    ("landmarks/text_refiner", "landmarks/text_refiner_test landmarks/text_order_test landmarks/planarity_test " + MAP),
    ("landmarks/text_view", "landmarks/text_hosting_test landmarks/text_rows_test " + MAP),
    ("landmarks/text_(bounds|hosting|life|merge|noise)", r"landmarks/text_\1_test " + MAP),
    ("landmarks/text_object", "landmarks/text_life_test " + MAP),
    ("landmarks/text_(terms|window)", "landmarks/text_terms_test landmarks/text_map_lens_test"),
    ("landmarks/", MAP),
]


def tests_of(header):
    """The tests that look at a header."""
    for pattern, tests in TESTS:
        found = re.match(pattern, header)
        if found:
            return found.expand(tests).split()
    raise ValueError(f"no tests are named for {header}")


def changes(line):
    """All lines that differ from this one by one change."""
    code = line.partition("//")[0]
    if re.match(r"\s*(#|template|static_assert|using|namespace|TEXTPLANE_(INSTANCE|DEFERRED))", code):
        return []
    code = re.sub(r"(Matrix|Eigen|Wide|block)<[^<>]*>", lambda m: m[0].replace("1", "_").replace("2", "_").replace("3", "_"), code)
    found = [line[:m.start()] + new + line[m.end():] for old, new in OPERATORS for m in re.finditer(old, code)]
    for m in INTEGER.finditer(code):
        found += [line[:m.start()] + str(int(m[1]) + by) + line[m.end():] for by in (1, -1) if int(m[1]) + by >= 0]
    for m in REAL.finditer(code):
        found.append(f"{line[:m.start()]}{float(m[1]) * 2 + (float(m[1]) == 0)!r}{line[m.end():]}")
    return found


def around(lines, number):
    """The line and as many before it as make the text unique."""
    text = "\n".join(lines)
    for first in range(number, -1, -1):
        piece = "\n".join(lines[first:number + 1])
        if text.count(piece) == 1:
            return first, piece
    return None


def lot(seed, *parts):
    """A number as if drawn, which no change elsewhere in the sources alters."""
    return hashlib.sha256("\0".join([str(seed), *parts]).encode()).digest()


def draw(include: pathlib.Path, count, seed):
    """`count` mutants as mutants.py has them: (header, text, text instead, tests)."""
    every = []
    for path in sorted([*include.rglob("*.hpp"), *include.rglob("*.inl")]):
        header = path.relative_to(include).as_posix()
        if LEFT_OUT.search(header):
            continue
        lines = path.read_text().split("\n")
        for number, line in enumerate(lines):
            for new in changes(line):
                place = around(lines, number)
                if place:
                    old, whole = place[1], "\n".join([*lines[place[0]:number], new])
                    every.append((header, old, whole, tests_of(header)))
    return sorted(every, key=lambda mutant: lot(seed, *mutant[:3]))[:count]

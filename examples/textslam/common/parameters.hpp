// Parameters: every number the system works with, in one place. The paper (Li et al., ICRA 2020) gives those marked so; the
// others are ours. Nothing depends on the kind of sequence.
#ifndef TEXTSLAM_COMMON_PARAMETERS_HPP
#define TEXTSLAM_COMMON_PARAMETERS_HPP

namespace textslam {

enum class Mode {
  text,    ///< Points and text planes in one cost.
  points,  ///< Points alone; detections are not looked at.
  loose,   ///< The paper's comparison: poses and points as in `points`; text planes fitted to the points afterwards.
};

struct Parameters {
  Mode mode = Mode::text;
  bool real_time = false;  ///< Adjustment and detector on threads of their own; what comes out depends on their timing.

  // Images
  int pyramid_levels = 4;

  // Corners and their tracks
  int max_tracks = 500;               ///< Corners followed at a time.
  int corner_cell = 20;               ///< px: at most one new corner in a cell of this size.
  int fast_threshold = 20;            ///< Grey levels; halved where the image gives too few corners.
  int min_fast_threshold = 7;         ///< Grey levels.
  int klt_half_window = 7;            ///< px.
  float max_forward_backward = 0.5F;  ///< px, between a corner and its image tracked forth and back.
  float min_track_zncc = 0.8F;        ///< Of a corner's window in two neighbouring frames.

  // Two-view initialisation
  int init_min_matches = 80;         ///< Fewer tracks since the reference frame start anew,
  int init_min_text_matches = 40;    ///< unless as many are on texts: two signs on a blank wall may start the map.
  double init_min_parallax = 1.2;    ///< Degrees, median over the matches, rotation removed.
  double init_max_direction = 0.06;  ///< Radians: standard deviation of the direction of translation.
  double init_max_rms = 1.0;         ///< px, epipolar distance of the inliers.
  double init_clear = 5;       ///< Standard deviations of noise by which the best of several motions must be better.
  int init_views = 8;          ///< That rival motions are adjusted over; then the newest takes the last one's place.
  double init_view_flow = 10;  ///< px: median motion of the corners between two of them.
  int init_patience = 60;      ///< Frames after which the best of several motions is taken all the same.

  // Pose of a frame
  double point_sigma = 1.0;         ///< px: sigma_rep of the paper, for a corner on level 0.
  double photometric_sigma = 1.0;   ///< Per pixel, in units of 1/sqrt(N): sigma_photo; see Weighting::variance.
  double outlier_chi2 = 5.991;      ///< 95 % of chi-square with 2 degrees of freedom.
  int min_inliers = 20;             ///< Points; fewer, without text to make up for them, count as lost.
  double min_inlier_share = 0.35;   ///< Of the tracked map points.
  double relocation_search = 8;     ///< px: how far a map point may be found from its prediction.
  float min_template_zncc = 0.75F;  ///< Between a point's key-frame patch and the image.
  int max_reobserved = 300;         ///< Map points searched for in a frame.

  // Key frames
  int keyframe_min_gap = 3;         ///< Frames.
  double keyframe_flow = 25;        ///< px: median motion of the points since the last key frame.
  double keyframe_min_share = 0.7;  ///< Of the last key frame's points still tracked.
  int redundant_views = 20;         ///< Of a point or text in other key frames; one whose points
  double redundant_share = 0.9;     ///< have as many, this share of them, is culled.

  // Points
  double min_parallax = 1.0;      ///< Degrees, for triangulation.
  double max_reprojection = 2.0;  ///< px, of a new point in each of its key frames.
  double min_found_share = 0.25;  ///< A point found in fewer of the frames that should see it is dropped.

  // Local map
  int local_min_shared = 15;  ///< Points that make two key frames neighbours; one mapped text in both does as well.

  // Text
  int text_min_observations = 5;   ///< The paper's n_min.
  int text_min_detections = 3;     ///< Frames in which the detector saw it.
  int text_min_pixels = 15;        ///< The paper's minimum of FAST points on a text.
  int text_max_pixels = 250;       ///< A level.
  int text_corners = 24;           ///< Corners tracked on a new text.
  int text_levels = 3;             ///< Pyramid levels of a patch.
  double text_border = 4;          ///< px that a new quad keeps from the image border.
  double text_overlap = 0.1;       ///< Share of a new quad that may lie on a known text.
  double text_min_area = 200;      ///< px^2.
  double text_min_share = 0.5;     ///< Of a quad, inside the image: less of it is no observation.
  double text_min_parallax = 1.0;  ///< Degrees, median over its corners, before theta is solved for.
  double text_min_zncc = 0.65;     ///< Of an observation that counts.
  double text_cull_zncc = 0.55;    ///< Below it, an observation counts against the object.
  double text_max_slant = 78;      ///< Degrees between viewing ray and normal.
  int text_patience = 25;          ///< Key frames a candidate may wait for its plane.
  int text_targets = 8;            ///< Key frames that a plane is refined against.
  double rehost_area = 4;          ///< So many times as large, a pyramid level, a text's next host shows it,
  double rehost_slant = 5;         ///< at most so many degrees more slanted; and 1 - ZNCC of its other key frames
  double rehost_unlike = 1.5;      ///< becomes at most so many times as large, else the new one is blurred.

  // Last refinement of the text planes
  int refine_hosts = 8;         ///< Key frames that a text is compared from, the largest views among them,
  double refine_area = 0.4;     ///< each showing it at least this large, as a share of the largest view.
  double refine_scale = 2;      ///< One that shows it this much smaller than the host is not compared with it.
  int refine_targets = 24;      ///< Key frames that each is compared with.
  double refine_unlike = 1.5;   ///< One whose 1 - ZNCC is this many times the median is blurred or hidden: left out.
  int refine_pixels = 1000;     ///< Of the text.
  double refine_max_sigma = 5;  ///< Degrees: a text whose normal is known no better is no part of the map.
  double refine_margin = 3;     ///< px around the quad that belong to it: edges of letters with both their sides.
  double blur_variance = 0.25;  ///< px^2 of a camera's own blur.
  double blur_spread = 2.5;     ///< See textplane::match_blur().

  // Surface that a text lies on, in that refinement, and first of all for a text whose corners are lost
  double surface_reach = 3;      ///< Map points up to so many times the text's longer side beside it tell of its plane.
  double surface_relief = 0.06;  ///< What lies beside a text is off its plane by this share of the distance: a sigma,
  double surface_bend = 0.25;    ///< and all of it together turned from the text's normal by this: a sigma, degrees.
  double surface_min_points = 6;  ///< That count, each by its weight of at most 1; fewer change nothing.
  double surface_max_sigma = 2;   ///< Degrees: where points alone leave a normal less sure, they give a text no plane.

  // Reading of the mapped texts, in the end, where there is a reader
  int reading_views = 8;    ///< Key frames that a text is read in, those that show it sharpest.
  int reading_height = 40;  ///< px of the text, seen squarely.

  // Text planes in mode `loose`
  double loose_inlier = 0.01;    ///< Relative depth error of a point on the plane.
  int loose_draws = 1000;        ///< Of three points; all that there are where they are fewer.
  int loose_min_points = 6;      ///< On the plane: as many as the linear system of mode `text` asks for.
  double loose_min_share = 0.5;  ///< Of the points in the quad.
  int loose_seen_points = 3;     ///< Of the plane's points, in a key frame that observes it.

  // Bundle adjustment
  int window_frames = 20;  ///< Free key frames of the local adjustment.
  int window_fixed = 25;   ///< Fixed key frames around them.
  int window_iterations = 8;
  double whole_growth = 1.05;   ///< A map with so many times the key frames of then is adjusted as a whole again,
  int whole_most_frames = 150;  ///< up to this many key frames: beyond, it would take long, and adjustments are local.
  int final_iterations = 30;    ///< Of the adjustment over all key frames at the end,
  int final_text_targets = 64;  ///< in which a plane meets this many key frames.
  double window_point_sigma = 0.5;  ///< px; below point_sigma: what does not fit weighs little.

  // Last poses of the frames between key frames
  int refit_min_points = 40;   ///< Map points, else the pose stays as it was to its key frame.
  int refit_max_points = 250;  ///< Remembered of a frame.
  int refit_frames = 3000;     ///< Older ones get their last pose at once, lest memory grows with the way.

  // Recovery
  int relocalise_candidates = 5;        ///< Key frames tried for a lost frame.
  int relocalise_hypotheses = 6;        ///< Poses by single texts that are tried in full.
  double relocalise_search_zncc = 0.4;  ///< Of a text under the pose of its corners, after a coarse search.
  double relocalise_min_share = 0.2;    ///< Of the map points that a pose should see; fewer speak against it.
  int young_map_keyframes = 5;          ///< A map of fewer that is lost soon was not a good one:
  int young_map_patience = 15;          ///< after this many lost frames a new one is begun,
  int lost_patience = 30;               ///< after this many where the map is older.

  // Loop closure
  bool loop_closure = true;
  double loop_drift =
      0.005;  ///< Sigma of what is lost on a way of one depth or radian: depths, radians, log of the scale.
  double loop_max_shift = 2;  ///< px, median, by which old points are off: more is spread over the way since then.

  // Merging of texts that are one
  double merge_angle = 8;      ///< Degrees between their normals,
  double merge_depth = 0.05;   ///< share of the inverse depth between their planes; both beside three sigma.
  double merge_overlap = 0.3;  ///< IoU of their quads.

  // Joining of maps
  int join_keyframes = 6;        ///< Newest key frames of a map that are looked for in an older one.
  int join_min_keyframes = 2;    ///< That must agree.
  int join_min_pairs = 20;       ///< Points, and corners of texts, that must agree in both maps,
  double join_tolerance = 0.05;  ///< within this share of their depth.
};

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_PARAMETERS_HPP

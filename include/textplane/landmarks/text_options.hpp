// TextOptions: every number that the life of a text object depends on.
#ifndef TEXTPLANE_LANDMARKS_TEXT_OPTIONS_HPP
#define TEXTPLANE_LANDMARKS_TEXT_OPTIONS_HPP

#include "textplane/config.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Numbers of the paper (Li et al., ICRA 2020) are marked so; the others were chosen on rendered rooms.
struct TextOptions {
  // Proposal: which quads become candidates.
  double border = 4;         ///< px that a new quad keeps from the image border.
  double overlap = 0.1;      ///< Share of a new quad that may lie on a known text (the paper: none).
  double min_area = 200;     ///< px^2 of a quad.
  int min_pixels = 15;       ///< The paper's minimum of FAST points on a text.
  int max_pixels = 250;      ///< On each pyramid level.
  int levels = 3;            ///< Pyramid levels of a patch.
  double confirm_iou = 0.4;  ///< IoU of a detection that counts for a text.

  // First plane.
  int min_corners = 6;           ///< Points or matches in the quad for a plane.
  double min_parallax = 1.0;     ///< Degrees: median over the matches, before a plane is solved for.
  int plane_rounds = 4;          ///< Rounds of solving for the plane and removing outliers.
  double plane_outlier = 2.5;    ///< Times the median error: matches farther off are outliers.
  double plane_min_error = 1.5;  ///< px: matches closer than this are no outliers.
  int patience = 25;             ///< Key frames that a candidate may wait for its plane.

  // Observations.
  int min_observations = 5;      ///< The paper's n_min: key frames that show a text, the host among them.
  int min_detections = 3;        ///< Frames in which the detector saw it.
  double detected_share = 0.05;  ///< Of the frames with detections that could have shown it.
  double min_zncc = 0.65;        ///< Of an observation that counts.
  double cull_zncc = 0.55;       ///< Below it, an observation counts against the text.
  double max_slant = 78;         ///< Degrees between viewing ray and normal.
  double seen_border = 1;        ///< px that a quad keeps from the border if all of it must be seen.
  double seen_area = 0.5;        ///< Of min_area: a smaller image of a text is no observation.
  double min_share = 0.5;        ///< Of a quad, inside the image: less of it is no observation.
  int views = 8;                 ///< Key frames that a plane is refined against as they come.
  int tentative_patience = 50;   ///< Key frames that a text may wait to be mapped.
  int max_failures = 5;          ///< A text is dropped if so many key frames in a row should show it and do not.

  // Noise: limits of the ZNCC are for clear images.
  double clear_noise = 4;            ///< Grey levels: limits of the ZNCC are for images with no more.
  double least_expected_zncc = 0.6;  ///< With less to expect for the noise, the limits fall no further.

  // A better host.
  double rehost_area = 4;                 ///< Larger by this factor, a key frame's view may replace the host's.
  double rehost_slant = 5;                ///< Degrees that the new host may be more slanted.
  double rehost_max_dissimilarity = 1.5;  ///< Factor by which 1 - ZNCC of the other key frames may grow.

  // The plane from many views.
  int refine_hosts = 8;                   ///< Key frames that a text is compared from, the largest view among them.
  double refine_area = 0.4;               ///< Its area in such a key frame, at least, as a share of the largest view.
  double refine_scale = 2;                ///< A view smaller than the host by this factor is not compared with it.
  int refine_views = 24;                  ///< Key frames that each host is compared with.
  double refine_max_dissimilarity = 1.5;  ///< A view whose 1 - ZNCC is this many times the median is left out.
  int refine_pixels = 1000;               ///< Of the text.
  double refine_margin = 3;         ///< px around the quad that belong to it: edges of letters with both their sides.
  int refine_reach = 8;             ///< px around the quad that are blurred.
  double blur_variance = 0.25;      ///< px^2 of a camera's own blur.
  double blur_spread = 2.5;         ///< See match_blur().
  double refine_most_bend = 0.35;   ///< Tangent of the turn of the normal from end to end: less counts as planar.
  double refine_bend_sigmas = 3;    ///< Standard deviations: a larger bend makes a plane less sure, or is refused.
  double refine_bend_share = 0.25;  ///< Of the views' disagreement: a bend that explains less is not believed.
  double refine_max_sigma = 5;      ///< Degrees: a text is dropped in the end if its normal is less certain.

  // The surface that a text lies on.
  double surface_reach = 2;         ///< Times the text's longer side: how far beside it map points count.
  double surface_relief = 0.06;     ///< Sigma of a point off the plane, as a share of its distance from the text.
  double surface_bend = 0.25;       ///< Degrees: sigma between the normals of the surface and of the text.
  double surface_gap = 0.02;        ///< Of the longer side: how far the centre may be off the surface that it lies on.
  double surface_most_turn = 5;     ///< Degrees: sigma of the slant of the surface beside a text, where that is sought.
  double surface_near = 0.1;        ///< Of the longer side: sigma of its distance from the text, where it is sought.
  double surface_min_points = 6;    ///< Sum of the weights, each at most 1; with less, the plane stays as it was.
  double surface_max_sigma = 2;     ///< Degrees: points alone give a plane where its normal is known this well.
  double surface_text_sigma = 20;   ///< Degrees: no surface speaks for a text whose own normal is less certain.
  double surface_sigmas = 3;        ///< Points beyond have no weight (Tukey).
  int surface_rounds = 20;          ///< Of weighting and fitting.
  double surface_guess_turn = 0.6;  ///< Radians: sigma of the normal of a guessed plane.
  double surface_guess_depth = 0.1;  ///< Sigma of the depth of a guessed plane, as a share.

  // Words.
  int max_readings = 32;   ///< Different readings of a text that are kept.
  double same_word = 0.5;  ///< Similarity of two readings of one word: a quarter of the letters may differ.

  // Duplicates.
  double merge_angle = 8;      ///< Degrees between the normals, merge_sigmas aside.
  double merge_depth = 0.05;   ///< Relative difference of the inverse depths, merge_sigmas aside.
  double merge_sigmas = 3;     ///< Standard deviations by which both may differ further.
  double merge_overlap = 0.3;  ///< IoU of their quads.
};

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_TEXT_OPTIONS_HPP

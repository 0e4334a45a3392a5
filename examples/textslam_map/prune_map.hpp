// A map file without what is not wanted any more.
#ifndef TEXTSLAM_MAP_PRUNE_MAP_HPP
#define TEXTSLAM_MAP_PRUNE_MAP_HPP

#include <cstdint>
#include <optional>
#include <string>

namespace textslam {

/// What goes. Each rule is for all that the map holds; the session goes first, so that the others count what is left.
struct PruneRules {
  /// Texts that fewer key frames observe, the host among them.
  std::optional<int> min_observations;
  /// Texts whose normal has a larger standard deviation, degrees.
  std::optional<double> max_sigma;
  /// The key frames of this session but those that others need: the map's first one, which its world hangs on, and
  /// hosts of texts that key frames of other sessions observe. Texts that no key frame of another session observes or
  /// hosts go with it, and so do points that fewer than two of the key frames left see.
  std::optional<int> session;
};

/// Rows that went, and how many bytes shorter the file is.
struct Pruned {
  std::int64_t texts = 0, keyframes = 0, images = 0, points = 0, observations = 0, sessions = 0;
  std::int64_t bytes = 0;
};

/// Takes away what the rules name and what belongs to it in one transaction, then gives the space back. Whatever ends
/// it, the file holds the old map or the new one. With `dry_run` it only says what would go, and no byte changes.
/// InputError where the file is no map, has no such session, or no other; std::runtime_error where it cannot be
/// written.
Pruned prune_map(const std::string& path, const PruneRules& rules, bool dry_run);

/// For people, a line.
std::string pruned_text(const Pruned& pruned, bool dry_run);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_PRUNE_MAP_HPP

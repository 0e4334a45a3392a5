// The plug-ins: detectors, readers and video files.
#ifndef TEXTSLAM_PLUGINS_PLUGINS_HPP
#define TEXTSLAM_PLUGINS_PLUGINS_HPP

namespace textslam {

/// Registers the plug-ins that were built, and how to build the others. A main() calls it before it reads its options.
void register_plugins();

}  // namespace textslam

#endif  // TEXTSLAM_PLUGINS_PLUGINS_HPP

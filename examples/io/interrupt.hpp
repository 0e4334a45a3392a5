// Interrupt: SIGINT and SIGTERM ask a program to stop and to write what it has; a second one ends it at once.
#ifndef TEXTSLAM_IO_INTERRUPT_HPP
#define TEXTSLAM_IO_INTERRUPT_HPP

namespace textslam {

/// Begins to record the two signals; call it once, at the start of main.
void note_interrupts();

/// The signal that arrived; 0: none so far. Safe to call from any thread.
int interrupted();

}  // namespace textslam

#endif  // TEXTSLAM_IO_INTERRUPT_HPP

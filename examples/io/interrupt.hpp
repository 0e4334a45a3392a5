// Interrupt: SIGINT and SIGTERM ask a program to stop and to write what it has; a second one ends it at once.
#ifndef TEXTSLAM_IO_INTERRUPT_HPP
#define TEXTSLAM_IO_INTERRUPT_HPP

namespace textslam {

/// From now on the two signals are noted; call it once, at the start of main.
void note_interrupts();

/// The signal that came, 0 while none did. Safe to call from any thread.
int interrupted();

}  // namespace textslam

#endif  // TEXTSLAM_IO_INTERRUPT_HPP

;; Opens the spec that SPEC names, waits for a diagnostic, and prints it with the mode of the buffer.
(find-file (getenv "SPEC"))
(run-hooks 'post-command-hook) ; which eglot-ensure waits for, and which batch mode does not run
(let ((end (+ (float-time) 30)) found)
  (while (and (not found) (< (float-time) end))
    (accept-process-output nil 0.1)
    (when (bound-and-true-p flymake-mode)
      (setq found (car (flymake-diagnostics)))))
  (princ (format "%s %s %s" major-mode
                 (and found (line-number-at-pos (flymake-diagnostic-beg found)))
                 (and found (flymake-diagnostic-text found)))))
(kill-emacs)

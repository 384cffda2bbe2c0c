"""Remote control of post-process volumes: HTTP on loopback, OSC as an extra; off by default."""

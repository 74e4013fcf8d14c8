"""What a robot is at a glance: values such as those of `tree`, and their text in modules named after the form."""

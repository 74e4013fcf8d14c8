from launch.substitution import Substitution
from launch.substitutions import TextSubstitution


def normalize_to_list_of_substitutions(some):
    items = [some] if isinstance(some, str | Substitution) else list(some)
    return [item if isinstance(item, Substitution) else TextSubstitution(text=item) for item in items]


def perform_substitutions(context, substitutions):
    return "".join(each.perform(context) for each in substitutions)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The files for containers and Kubernetes are what their programs take, and agree with one another. No cluster is
needed: docker-compose validates with the schema of compose, and Kubernetes' Python client has its API's as classes."""
import copy
import re

import kubernetes.client
import yaml

from observation_test import known_metrics
from places import DEPLOY
from processes import ANTICRACKD, FolderTest, run
from unit_test import seconds

COMPOSE = DEPLOY / "compose.group.yaml"
KUBERNETES = DEPLOY / "kubernetes"
# Debian 12's client is older than autoscaling/v2, which became of v2beta2 with the same fields.
KINDS = {"autoscaling/v2": ["V2", "V2beta2"]}
PLAIN = {"str": str, "int": int, "bool": bool, "float": (int, float), "object": object}


def checked(value, kind, where):
    """Raises ValueError where a value is not of a kind of the API."""
    if found := re.fullmatch(r"list\[(.*)\]", kind):
        if not isinstance(value, list):
            raise ValueError(f"{where} is no list")
        return [checked(one, found.group(1), f"{where}[{i}]") for i, one in enumerate(value)]
    if found := re.fullmatch(r"dict\(str, (.*)\)", kind):
        return {key: checked(one, found.group(1), f"{where}.{key}") for key, one in value.items()}
    if kind in PLAIN:
        if not isinstance(value, PLAIN[kind]) or (kind == "int" and isinstance(value, bool)):
            raise ValueError(f"{where} is no {kind}: {value}")
        return value
    model = getattr(kubernetes.client, kind)
    names = {key: name for name, key in model.attribute_map.items()}
    if unknown := set(value) - set(names):
        raise ValueError(f"{where} has no {unknown}")
    return model(**{names[key]: checked(one, model.openapi_types[names[key]], f"{where}.{key}")
                    for key, one in value.items()})  # it knows what is required


def checked_object(value):
    version = value["apiVersion"]
    for prefix in KINDS.get(version, [version.rsplit("/", 1)[-1].capitalize()]):
        if hasattr(kubernetes.client, prefix + value["kind"]):
            return checked(value, prefix + value["kind"], value["kind"])
    raise ValueError(f"there is no {version} {value['kind']}")


def manifests():
    texts = [path.read_text(encoding="utf-8") for path in sorted(KUBERNETES.glob("*.yaml"))]
    return [one for text in texts for one in yaml.safe_load_all(text)]


def of_kind(kind, name="anticrack"):
    return next(one for one in manifests() if one["kind"] == kind and one["metadata"]["name"] == name)


def flags(words):
    return dict(re.fullmatch(r"--([a-z-]+)=(.*)", word).groups() for word in words)


class Schemas(FolderTest):
    def compose(self, text):
        path = self.folder / "compose.yaml"
        path.write_text(text, encoding="utf-8")
        return run("docker-compose", "-f", path, "config", "-q")

    def test_compose_takes_the_group(self):
        text = COMPOSE.read_text(encoding="utf-8")
        ended = self.compose(text)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        for right, wrong in (("restart:", "restarts:"), ("cap_drop: [ALL]", "cap_drop: 1"), ("[postgresql]", "[db]")):
            self.assertIn(right, text)
            self.assertNotEqual(self.compose(text.replace(right, wrong)).returncode, 0, wrong)

    def test_kubernetes_takes_the_group(self):
        for one in manifests():
            checked_object(one)
        self.assertEqual({one["kind"] for one in manifests()},
                         {"Service", "Deployment", "PodDisruptionBudget", "HorizontalPodAutoscaler", "ConfigMap"})

    def test_what_kubernetes_would_refuse_is_found(self):
        def pod(one):
            return one["spec"]["template"]["spec"]

        def container(one):
            return pod(one)["containers"][0]
        for change in (lambda one: one["spec"].pop("selector"), lambda one: container(one).pop("name"),
                       lambda one: container(one)["ports"][0].pop("containerPort"),
                       lambda one: container(one)["readinessProbe"].update(periodsSeconds=2),
                       lambda one: container(one)["readinessProbe"].update(periodSeconds="2"),
                       lambda one: pod(one).update(volumes={}), lambda one: one.update(apiVersion="apps/v9"),
                       lambda one: container(one)["env"][0].update(value=1)):
            wrong = copy.deepcopy(of_kind("Deployment"))
            change(wrong)
            with self.assertRaises((ValueError, TypeError)):
                checked_object(wrong)


class Agreement(FolderTest):
    """What stands in two files is the same."""

    def setUp(self):
        super().setUp()
        self.haproxy = (DEPLOY / "haproxy.cfg").read_text(encoding="utf-8")
        self.services = yaml.safe_load(COMPOSE.read_text(encoding="utf-8"))["services"]
        self.servers = {name: one for name, one in self.services.items() if name.startswith("anticrack-")}
        self.deployment = of_kind("Deployment")
        self.pod = self.deployment["spec"]["template"]["spec"]
        self.container = self.pod["containers"][0]
        self.given = [flags(next(iter(self.servers.values()))["command"]), flags(self.container["args"])]
        image = (DEPLOY / "Containerfile").read_text(encoding="utf-8")
        self.exposed = re.search(r"^EXPOSE (.*)", image, re.M).group(1).split()
        self.data = re.search(r"^VOLUME (.*)", image, re.M).group(1)

    def test_of_ports(self):
        call, metrics = self.exposed
        for one in self.given:
            self.assertEqual(one["listen"], f"0.0.0.0:{call}")
            self.assertEqual(one["metrics-listen"], f"0.0.0.0:{metrics}")
        servers = re.findall(r"^ *server (\S+) (\S+):(\d+) check port (\d+)$", self.haproxy, re.M)
        self.assertEqual(servers, [(name, name, call, metrics) for name in self.servers])
        self.assertIn(f"bind :{call} ", self.haproxy)
        self.assertEqual(self.services["haproxy"]["ports"], [f"{call}:{call}"])
        self.assertEqual({port["name"]: str(port["containerPort"]) for port in self.container["ports"]},
                         {"grpc": call, "metrics": metrics})
        for service in (of_kind("Service"), of_kind("Service", "anticrack-servers")):
            for port in service["spec"]["ports"]:
                self.assertEqual((str(port["port"]), port["targetPort"]),
                                 (call if port["name"] == "grpc" else metrics, port["name"]))
        self.assertEqual(self.deployment["spec"]["template"]["metadata"]["annotations"]["prometheus.io/port"], metrics)

    def test_of_names(self):
        labels = self.deployment["spec"]["template"]["metadata"]["labels"]
        for one in (self.deployment, of_kind("PodDisruptionBudget")):
            self.assertEqual(one["spec"]["selector"]["matchLabels"], labels)
        self.assertEqual(self.pod["topologySpreadConstraints"][0]["labelSelector"]["matchLabels"], labels)
        for name in ("anticrack", "anticrack-servers"):
            self.assertEqual(of_kind("Service", name)["spec"]["selector"], labels)
        scaled = of_kind("HorizontalPodAutoscaler")["spec"]
        self.assertEqual(scaled["scaleTargetRef"]["name"], self.deployment["metadata"]["name"])
        self.assertEqual(scaled["minReplicas"], self.deployment["spec"]["replicas"])
        rule = yaml.safe_load(of_kind("ConfigMap", "prometheus-adapter-anticrack")["data"]["config.yaml"])
        rule, = rule["externalRules"]
        self.assertEqual(scaled["metrics"][0]["external"]["metric"]["name"], rule["name"]["as"])
        self.assertIn(re.match(r"\w+", rule["seriesQuery"]).group(0), known_metrics())
        self.assertIn(rule["seriesQuery"], rule["metricsQuery"])
        self.assertEqual(self.container["image"], next(iter(self.servers.values()))["image"])
        database = self.services["postgresql"]["environment"]
        url = f"postgresql://{database['POSTGRES_USER']}@postgresql/{database['POSTGRES_DB']}"
        self.assertEqual({one["store"] for one in self.given}, {url})

    def test_of_paths(self):
        mounts = {mount["mountPath"]: mount["name"] for mount in self.container["volumeMounts"]}
        self.assertEqual(set(mounts.values()), {volume["name"] for volume in self.pod["volumes"]})
        self.assertIn(self.data, mounts)
        to = [volume.split(":")[1] for volume in self.services["haproxy"]["volumes"]]
        for path in re.findall(r"(?:crt|ca-file) (/\S+)", self.haproxy):
            self.assertIn(path, to)
        for one, folder in zip(self.given, ("/certificates", "/secrets")):
            self.assertEqual({value.rsplit("/", 1)[0] for value in one.values() if value.startswith("/")}, {folder})

    def test_of_times(self):
        inter, fall = re.search(r"inter (\w+) fall (\d+)", self.haproxy).groups()
        fall = seconds(inter) * int(fall)
        probe = self.container["readinessProbe"]
        for one, grace in zip(self.given, (seconds(next(iter(self.servers.values()))["stop_grace_period"]),
                                           self.pod["terminationGracePeriodSeconds"])):
            delay, time = seconds(one["drain-delay"]), seconds(one["drain-time"])
            self.assertGreater(delay, fall)
            self.assertGreater(delay, probe["periodSeconds"] * probe["failureThreshold"])
            self.assertGreater(grace, delay + time + 10)

    def test_of_the_server_with_its_flags(self):
        made = self.folder / "made"
        self.assertEqual(run(DEPLOY / "make-certificates", made).returncode, 0)
        token = run(DEPLOY / "make-certificates", "token", "ann", "user").stdout
        (made / "tokens").write_text(re.search(r"file: (.*)", token).group(1) + "\n", encoding="utf-8")
        for one, folder in zip(self.given, ("/certificates", "/secrets")):
            words = [f"--{key}={value.replace(folder, str(made))}" for key, value in one.items()]
            ended = run(ANTICRACKD, "--data-dir", self.folder / "data", *words, "--check-config")
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))

    def test_of_the_page_that_says_who_is_ready(self):
        self.assertEqual(self.container["readinessProbe"]["httpGet"]["path"],
                         re.search(r"httpchk GET (\S+)", self.haproxy).group(1))
